#pragma once

#include "scene/environment.hpp"
#include "scene/scene.hpp"
#include "scenes/generator/gltf/document.hpp"
#include "scenes/generator/sky/environment.hpp"

namespace heliograph::test {

/// The document as any user's: written to a file with maps of `texture_size` pixels, and imported.
/// @throws std::exception
scene::Scene import_generated(const scenes::Document& document, int texture_size);

scene::Environment import_generated(const scenes::Environment& sky);

}  // namespace heliograph::test
