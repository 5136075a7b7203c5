#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scene/gltf/document/json_value.hpp"

namespace heliograph::scene {

/// The names of KHR_materials_variants in document order; also checks the mappings of all
/// primitives.
/// @throws ImportError
std::vector<std::string> read_variants(const JsonValue& root, std::size_t material_count);

/// The material of a checked primitive in `variant`; nullopt where the variant does not change it.
std::optional<std::uint32_t> material_of_variant(const JsonValue& primitive, std::uint32_t variant);

}  // namespace heliograph::scene
