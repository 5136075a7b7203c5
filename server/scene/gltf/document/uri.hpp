#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace heliograph::scene {

/// The bytes of a base64 "data:" URI (RFC 2397), or nullopt when `uri` is none.
/// @throws ImportError when it is one but cannot be decoded
std::optional<std::vector<std::uint8_t>> decode_data_uri(std::string_view uri);

/// The relative file path that `uri` names, percent decoded once (RFC 3986).
/// @throws ImportError for other schemes and malformed escapes
std::string decode_file_uri(std::string_view uri);

}  // namespace heliograph::scene
