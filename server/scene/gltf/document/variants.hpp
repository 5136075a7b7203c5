#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace heliograph::scene {

/// The names of KHR_materials_variants in document order; also checks the mappings of all
/// primitives.
/// @throws ImportError
std::vector<std::string> read_variants(const tinygltf::Model& model);

/// The material of a checked primitive in `variant`; nullopt where the variant does not change it.
std::optional<std::uint32_t> material_of_variant(const tinygltf::Primitive& primitive,
                                                 std::uint32_t variant);

}  // namespace heliograph::scene
