#pragma once

#include <array>
#include <cstdint>

#include "gpu/memory/image.hpp"

namespace heliograph::render {

inline constexpr std::uint32_t ltc_table_size = 64;

/// Inverse matrices of the cosines that match the specular lobe: four half floats each, the entries
/// (0,0), (2,0), (0,2), (2,2) (row, column) where (1,1) is 1. Rows: roughness from 0 to 1; columns:
/// sqrt(1 - n.v).
extern const std::array<std::uint64_t, ltc_table_size * ltc_table_size> ltc_table;

/// The table as an image of four floats (shaders/lib/lighting/ltc.glsl).
gpu::Image make_ltc_image(const gpu::Device& device);

}  // namespace heliograph::render
