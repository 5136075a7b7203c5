#pragma once

#include <span>
#include <string_view>

namespace heliograph::web {

/// One file of the web client, compiled into the binary.
struct Asset {
  std::string_view path;          ///< below the root, without a leading slash: "app.js"
  std::string_view content_type;  ///< value of the Content-Type header
  std::string_view etag;          ///< strong validator with its quotes, a hash of the bytes
  std::span<const unsigned char> bytes;
};

/// Finds a file by its path, with or without a leading slash; "" and "/" are index.html.
/// Returns nullptr when there is none. The asset lives as long as the program.
const Asset* find_asset(std::string_view path);

}  // namespace heliograph::web
