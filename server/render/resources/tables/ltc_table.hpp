#pragma once

#include <array>
#include <cstdint>

#include "gpu/memory/image.hpp"

namespace heliograph::render {

inline constexpr std::uint32_t ltc_table_size = 64;

/// Inverse matrices of the cosines that match the specular lobe, as an image of four floats
/// (shaders/lib/lighting/ltc.glsl): the entries (0,0), (2,0), (0,2), (2,2) (row, column) where
/// (1,1) is 1. Rows: roughness from 0 to 1; columns: sqrt(1 - n.v). The values are ltc_table.inc,
/// half floats that fit_ltc prints; the test ltc_table fits them again.
gpu::Image make_ltc_image(const gpu::Device& device);

}  // namespace heliograph::render
