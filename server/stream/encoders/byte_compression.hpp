#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace heliograph::stream {

/// In the zlib format (RFC 1950), fast. @throws std::runtime_error
std::vector<std::uint8_t> compress_bytes(std::span<const std::uint8_t> bytes);

}  // namespace heliograph::stream
