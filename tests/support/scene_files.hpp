#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "scene/environment.hpp"
#include "scene/scene.hpp"
#include "scenes/generator/gltf/document.hpp"
#include "scenes/generator/sky/environment.hpp"

namespace heliograph::test {

/// A generated scene by way of a GLB file and the importer, as the server reads it.
std::shared_ptr<const scene::Scene> import_document(const scenes::Document& document,
                                                    int texture_size);

scene::Environment convert(const scenes::Environment& environment);

/// $HELIOGRAPH_TEST_ASSETS / `path`, or nothing where the variable is not set.
std::optional<std::filesystem::path> asset(const std::filesystem::path& path);

}  // namespace heliograph::test
