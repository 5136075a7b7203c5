#include "net/download/byte_range.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace heliograph::net {
namespace {

/// Bytes of a resource, the last one included.
struct ByteRange {
  std::uint64_t first = 0;
  std::uint64_t last = 0;
};

std::optional<std::uint64_t> decimal(std::string_view text) {
  std::uint64_t value = 0;
  const char* const end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, value);
  // Larger than any file: beyond the end as well as at its end.
  if (parsed.ec == std::errc::result_out_of_range) value = UINT64_MAX;
  const bool number = parsed.ec != std::errc::invalid_argument && parsed.ptr == end;
  return number ? std::optional(value) : std::nullopt;
}

/// "bytes=0-99", "bytes=100-" or "bytes=-100"; nothing for anything else. A range whose first byte
/// is not below `size` is beyond the end.
std::optional<ByteRange> byte_range(std::string_view header, std::uint64_t size) {
  constexpr std::string_view unit = "bytes=";
  if (lower(header.substr(0, unit.size())) != unit) return std::nullopt;
  const std::string_view range = trimmed(header.substr(unit.size()));
  const std::size_t dash = range.find('-');
  if (dash == std::string_view::npos) return std::nullopt;
  const std::string_view first_text = range.substr(0, dash), last_text = range.substr(dash + 1);
  const auto first = decimal(first_text), last = decimal(last_text);
  if (first_text.empty()) {
    if (!last) return std::nullopt;
    return ByteRange{.first = *last == 0 ? size : size - std::min(*last, size), .last = size - 1};
  }
  const bool open = last_text.empty();
  if (!first || (!open && (!last || *last < *first))) return std::nullopt;
  return ByteRange{.first = *first, .last = open ? size - 1 : std::min(*last, size - 1)};
}

std::string_view etag_of(const HttpResponse& response) {
  const auto found = std::ranges::find(response.headers, "ETag", &Headers::value_type::first);
  return found == response.headers.end() ? std::string_view() : std::string_view(found->second);
}

}  // namespace

HttpResponse requested_part(const HttpRequest& request, HttpResponse whole) {
  whole.headers.emplace_back("Accept-Ranges", "bytes");
  const std::string_view etag = etag_of(whole);
  for (const std::string_view tag : header_elements(request.header("if-none-match"))) {
    if (tag != etag && tag != "*") continue;
    whole.status = 304;
    whole.content.reset();
    return whole;
  }
  // A range is part of a GET only.
  if (request.method != "GET") return whole;
  const std::string_view version = request.header("if-range");
  if (!version.empty() && trimmed(version) != etag) return whole;
  const std::uint64_t size = whole.content->size();
  const auto range = byte_range(request.header("range"), size);
  if (!range) return whole;
  if (range->first >= size) {
    HttpResponse beyond = text_response(416, "The range begins beyond the end.");
    beyond.headers.emplace_back("Content-Range", "bytes */" + std::to_string(size));
    return beyond;
  }
  whole.status = 206;
  whole.headers.emplace_back("Content-Range", "bytes " + std::to_string(range->first) + "-" +
                                                  std::to_string(range->last) + "/" +
                                                  std::to_string(size));
  whole.content = whole.content->part(range->first, range->last - range->first + 1);
  return whole;
}

}  // namespace heliograph::net
