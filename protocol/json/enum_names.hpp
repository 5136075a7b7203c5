#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

namespace heliograph::protocol {

constexpr std::size_t count_names(std::string_view list) {
  return static_cast<std::size_t>(std::count(list.begin(), list.end(), ',')) + 1;
}

/// Splits "a, b_, c" into its names. A trailing underscore, which lets an enumerator avoid a
/// keyword (`virtual_`), is not part of the name.
template <std::size_t count>
constexpr std::array<std::string_view, count> split_names(std::string_view list) {
  std::array<std::string_view, count> names{};
  for (std::string_view& name : names) {
    const std::size_t end = std::min(list.find(','), list.size());
    name = list.substr(0, end);
    while (name.starts_with(' ')) name.remove_prefix(1);
    if (name.ends_with('_')) name.remove_suffix(1);
    list.remove_prefix(std::min(end + 1, list.size()));
  }
  return names;
}

/// Declares `enum class Name` whose enumerators count up from zero and are known by name at run
/// time, so that JSON, schema and command line need no second list.
#define HELIOGRAPH_ENUM(Name, ...)                                                   \
  enum class Name { __VA_ARGS__ };                                                   \
  constexpr auto list_enum_names(Name) {                                             \
    return ::heliograph::protocol::split_names< ::heliograph::protocol::count_names( \
        #__VA_ARGS__)>(#__VA_ARGS__);                                                \
  }

template <class Enum>
inline constexpr auto enum_name_table = list_enum_names(Enum{});

/// The names of a HELIOGRAPH_ENUM in the order of its values.
template <class Enum>
constexpr std::span<const std::string_view> enum_names() {
  return enum_name_table<Enum>;
}

template <class Enum>
constexpr std::string_view enum_name(Enum value) {
  return enum_names<Enum>()[static_cast<std::size_t>(value)];
}

template <class Enum>
constexpr std::optional<Enum> enum_value(std::string_view name) {
  const auto names = enum_names<Enum>();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<Enum>(found - names.begin());
}

}  // namespace heliograph::protocol
