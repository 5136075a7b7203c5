#pragma once

#include "scene/environment.hpp"
#include "scene/scene.hpp"
#include "scenes/generator/gltf/document.hpp"
#include "scenes/generator/sky/environment.hpp"

namespace heliograph::test {

/// Writes the document to a GLB file with maps of `texture_size` pixels and imports it, as the
/// server does with a user's file.
/// @throws std::exception
scene::Scene import_generated(const scenes::Document& document, int texture_size);

scene::Environment import_generated(const scenes::Environment& sky);

}  // namespace heliograph::test
