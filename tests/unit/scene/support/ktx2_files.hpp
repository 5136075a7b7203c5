#pragma once

#include <array>

#include "tests/unit/scene/support/gltf_builder.hpp"

namespace heliograph::scene::test {

/// A KTX2 file of one level of UASTC blocks, 16 bytes each.
Bytes ktx2_of_blocks(std::uint32_t width, std::uint32_t height, const Bytes& blocks,
                     bool zstandard = false);

/// A KTX2 file of 14 x 10 texels and four levels in ETC1S with alpha, of `etc1s_texel`, from
/// Khronos' encoder.
Bytes ktx2_of_etc1s();
std::array<int, 4> etc1s_texel(int x, int y);

}  // namespace heliograph::scene::test
