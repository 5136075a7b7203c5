#pragma once

#include <string>
#include <string_view>

namespace heliograph::scene {

/// Text from a file as it may appear in a message: short, quoted, printable ASCII.
inline std::string in_quotes(std::string_view text) {
  constexpr std::size_t max_length = 80;
  std::string result = "\"";
  for (const char c : text.substr(0, max_length)) result += c >= 0x20 && c < 0x7f ? c : '?';
  return result + (text.size() > max_length ? "...\"" : "\"");
}

}  // namespace heliograph::scene
