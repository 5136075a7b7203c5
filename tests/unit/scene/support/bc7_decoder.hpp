#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace heliograph::scene::test {

/// A block of BC7 as a device reads it.
struct DecodedBlock {
  int mode = 0;
  int partition = -1;                      // of modes with two subsets
  std::array<std::uint8_t, 64> rgba = {};  // a row after the other
};

/// Decodes the modes 1, 3, 5, 6 and 7 (Khronos Data Format, "BPTC"). @throws std::invalid_argument
/// for any other
DecodedBlock decode_bc7(std::span<const std::uint8_t, 16> block);

/// The subset of each texel, '0' or '1', in the partition of that number.
const char* two_subset_partition(int number);

}  // namespace heliograph::scene::test
