#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scene/gltf/document/json_value.hpp"

namespace heliograph::scene {

/// The names of KHR_materials_variants, in the document's order, with every mapping of a primitive
/// to one of them checked.
/// @throws ImportError
std::vector<std::string> read_variants(const JsonValue& root, std::size_t material_count);

/// The material that a primitive, checked before, takes in `variant`; nothing where that changes
/// nothing.
std::optional<std::uint32_t> material_of_variant(const JsonValue& primitive, std::uint32_t variant);

}  // namespace heliograph::scene
