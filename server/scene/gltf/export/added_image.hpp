#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace heliograph::scene {

/// An image of a document whose file is still to be embedded.
struct AddedImage {
  std::size_t image = 0;
  std::vector<std::uint8_t> file;
};

}  // namespace heliograph::scene
