#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace heliograph::stream {

/// RFC 4648 section 4, with padding.
std::string base64_encode(std::span<const std::uint8_t> bytes);

/// Decodes base64url text (RFC 4648 section 5, without padding); nullopt if it is malformed.
std::optional<std::string> base64url_decode(std::string_view text);

}  // namespace heliograph::stream
