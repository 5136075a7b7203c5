#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace heliograph::scene {

/// A value in a glTF document that knows its path for error messages: "nodes[3].mesh: 7 is not an
/// index into 2 meshes". Every access checks type and range; an absent member yields its default, a
/// member of the wrong type is rejected.
/// All members throw ImportError.
class JsonValue {
 public:
  JsonValue(const nlohmann::json& json, std::string path) : json_(&json), path_(std::move(path)) {}

  const std::string& path() const { return path_; }
  [[noreturn]] void refuse(std::string_view reason) const;
  [[noreturn]] void refuse(std::string_view key, std::string_view reason) const;

  bool has(std::string_view key) const;
  bool is_object(std::string_view key) const;
  std::optional<JsonValue> object(std::string_view key) const;
  /// The member at the end of a chain of objects, e.g. {"extensions", "KHR_materials_ior"}.
  std::optional<JsonValue> object(std::string_view key, std::string_view inner_key) const;
  std::vector<JsonValue> objects(std::string_view key) const;
  std::vector<std::string> keys() const;

  std::string text(std::string_view key) const;
  std::vector<std::string> texts(std::string_view key) const;
  bool boolean(std::string_view key, bool fallback) const;

  std::optional<float> number(std::string_view key) const;
  float number(std::string_view key, float fallback) const {
    return number(key).value_or(fallback);
  }
  std::optional<std::vector<float>> numbers(std::string_view key, std::size_t count) const;
  template <std::size_t count>
  std::array<float, count> numbers(std::string_view key,
                                   const std::array<float, count>& fallback) const {
    const auto found = numbers(key, count);
    if (!found) return fallback;
    std::array<float, count> result;
    for (std::size_t i = 0; i < count; ++i) result[i] = (*found)[i];
    return result;
  }

  std::optional<std::uint64_t> integer(std::string_view key) const;
  std::uint64_t integer(std::string_view key, std::uint64_t fallback) const {
    return integer(key).value_or(fallback);
  }
  std::uint64_t required_integer(std::string_view key) const;

  /// An index below `count`; `plural` names what is indexed, for the error.
  std::optional<std::uint32_t> index(std::string_view key, std::size_t count,
                                     std::string_view plural) const;
  std::uint32_t required_index(std::string_view key, std::size_t count,
                               std::string_view plural) const;
  std::vector<std::uint32_t> indices(std::string_view key, std::size_t count,
                                     std::string_view plural) const;

 private:
  const nlohmann::json* find(std::string_view key) const;
  std::string path_to(std::string_view key) const;

  const nlohmann::json* json_;
  std::string path_;
};

/// Parses a glTF document after a pass over the bytes has checked that it nests no deeper than
/// `max_depth` and has at most `max_values` values.
/// @throws ImportError
nlohmann::json parse_json(std::string_view text, std::uint32_t max_depth, std::uint64_t max_values);

}  // namespace heliograph::scene
