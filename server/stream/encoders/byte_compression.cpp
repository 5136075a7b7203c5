#include "stream/encoders/byte_compression.hpp"

#include <zlib.h>

#include <stdexcept>

namespace heliograph::stream {

std::vector<std::uint8_t> compress_bytes(std::span<const std::uint8_t> bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::vector<std::uint8_t> compressed(size);
  if (compress2(compressed.data(), &size, bytes.data(), static_cast<uLong>(bytes.size()),
                Z_BEST_SPEED) != Z_OK) {
    throw std::runtime_error("zlib: out of memory");
  }
  compressed.resize(size);
  return compressed;
}

}  // namespace heliograph::stream
