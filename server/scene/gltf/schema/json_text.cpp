#include "scene/gltf/schema/json_text.hpp"

#include <cstddef>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "scene/import_error.hpp"

namespace heliograph::scene {
namespace {

using nlohmann::json;

void check_shape(std::string_view text, std::uint32_t max_depth, std::uint64_t max_values,
                 const std::stop_token& stop) {
  std::uint32_t depth = 0;
  std::uint64_t values = 1;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    throw_if_cancelled(stop, i);
    if (in_string) {
      if (c == '\\') {
        ++i;
      } else if (c == '"') {
        in_string = false;
      }
      continue;
    }
    if (c == '"') in_string = true;
    if (c == ',' || c == '[' || c == '{') ++values;
    if (c == '[' || c == '{') ++depth;
    if ((c == ']' || c == '}') && depth > 0) --depth;
    if (depth > max_depth) {
      throw ImportError("JSON nests deeper than " + std::to_string(max_depth) + " levels");
    }
    if (values > max_values) {
      throw ImportError("JSON has more than " + std::to_string(max_values) + " values");
    }
  }
}

/// Iterates over a text, and ends a parser that is to stop.
class CancellableText {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  CancellableText(const char* at, const std::stop_token& stop) : at_(at), stop_(&stop) {}
  reference operator*() const { return *at_; }
  CancellableText& operator++() {
    throw_if_cancelled(*stop_, reinterpret_cast<std::uintptr_t>(++at_));
    return *this;
  }
  CancellableText operator++(int) {
    const CancellableText before = *this;
    ++*this;
    return before;
  }
  bool operator==(const CancellableText& other) const { return at_ == other.at_; }

 private:
  const char* at_;
  const std::stop_token* stop_;
};

}  // namespace

json parse_json(std::string_view text, std::uint32_t max_depth, std::uint64_t max_values,
                const std::stop_token& stop) {
  check_shape(text, max_depth, max_values, stop);
  try {
    json document = json::parse(CancellableText(text.data(), stop),
                                CancellableText(text.data() + text.size(), stop));
    if (!document.is_object()) throw ImportError("not a glTF file: the JSON is not an object");
    return document;
  } catch (const json::parse_error& error) {
    throw ImportError("not a glTF file: JSON syntax error at byte " + std::to_string(error.byte));
  } catch (const json::exception&) {
    throw ImportError("JSON holds a number that does not fit");
  }
}

}  // namespace heliograph::scene
