#pragma once

#include <concepts>
#include <cstddef>
#include <limits>
#include <optional>
#include <string_view>
#include <tuple>

namespace heliograph::protocol {

inline constexpr std::size_t unlimited_length = std::numeric_limits<std::size_t>::max();

/// What a field accepts beyond its type. The range holds for every number in it (the elements of a
/// vector, too); the length counts bytes of a string or elements of a list.
struct FieldLimits {
  double minimum = -std::numeric_limits<double>::infinity();
  double maximum = std::numeric_limits<double>::infinity();
  std::size_t min_length = 0;
  std::size_t max_length = unlimited_length;
};

/// How a field behaves when it is absent.
enum class Presence {
  required,   ///< refused (std::optional members: simply empty)
  defaulted,  ///< the member keeps the value the struct gives it
  or_null,    ///< std::optional members: written as null when empty
};

/// One declared member of a message: the single source for parsing, validation, writing and
/// schema. See `field()`.
template <class Struct, class Member>
struct Field {
  std::string_view name;
  Member Struct::*member;
  std::string_view help;
  std::string_view unit_name = {};
  FieldLimits limits = {};
  Presence presence = Presence::required;

  constexpr Field range(double minimum, double maximum) const {
    Field copy = *this;
    copy.limits.minimum = minimum;
    copy.limits.maximum = maximum;
    return copy;
  }
  constexpr Field length(std::size_t minimum, std::size_t maximum) const {
    Field copy = *this;
    copy.limits.min_length = minimum;
    copy.limits.max_length = maximum;
    return copy;
  }
  constexpr Field unit(std::string_view name_of_unit) const {
    Field copy = *this;
    copy.unit_name = name_of_unit;
    return copy;
  }
  constexpr Field or_default() const {
    Field copy = *this;
    copy.presence = Presence::defaulted;
    return copy;
  }
  constexpr Field or_null() const {
    Field copy = *this;
    copy.presence = Presence::or_null;
    return copy;
  }
};

/// A member of a patch (RFC 7386): absent, a new value, or null, which asks for the initial one.
template <class T>
struct Change {
  std::optional<T> value;
  bool reset = false;

  bool operator==(const Change&) const = default;
};

/// Declares a member of a message, in its `static constexpr auto fields()`:
///   return std::tuple{field("width", &Size::width, "Frame width.").range(16, 8192)};
/// Members may be bool, 32 or 64 bit integers, float, double, std::string, a HELIOGRAPH_ENUM,
/// std::array and std::vector of those, std::optional, Change, another message, or RawJson.
template <class Struct, class Member>
constexpr Field<Struct, Member> field(std::string_view name, Member Struct::*member,
                                      std::string_view help) {
  return {.name = name, .member = member, .help = help};
}

/// A struct that declares its fields.
template <class T>
concept Message = requires {
  T::fields();
};

/// A message that refuses members it does not know (`static constexpr bool strict = true`), as a
/// patch must: a mistyped name would silently change nothing.
template <class T>
concept StrictMessage = Message<T> && T::strict;

}  // namespace heliograph::protocol
