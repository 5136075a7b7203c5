#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "protocol/json/enum_names.hpp"
#include "protocol/result.hpp"
#include "protocol/settings/color.hpp"

namespace heliograph::protocol {

#define CHOICE(Type, ...) HELIOGRAPH_ENUM(Type, __VA_ARGS__)
#include "protocol/settings/settings.def"

// The structs whose members several groups have.
#define SHARED_TYPE(Type) \
  struct Type {           \
    bool operator==(const Type&) const = default;
#define SHARED_MEMBER(group, name, type, initial, limits, unit, resets, help) type name = initial;
#define END_SHARED_TYPE \
  }                     \
  ;
#include "protocol/settings/settings.def"

/// All settings of the renderer. Groups and members are the lines of settings.def:
/// `settings.tone_map.curve`. Values set through this library are always within their limits.
struct Settings {
#define GROUP(path, Type, title) \
  struct Type {                  \
    bool operator==(const Type&) const = default;
#define GROUP_OF(path, Type, Base, title, ...) \
  struct Type : Base {                         \
    Type() { __VA_ARGS__; }                    \
    bool operator==(const Type&) const = default;
#define SETTING(group, name, type, initial, limits, unit, resets, help) type name = initial;
#define INHERITED(...)
#define END_GROUP(name) \
  }                     \
  name;
#include "protocol/settings/settings.def"

  bool operator==(const Settings&) const = default;
};

/// Histories that a changed setting invalidates, as a bit mask.
enum class ResetScope : std::uint32_t {
  none = 0,
  accumulation = 1u << 0,  ///< the mean of a static view's samples
  history = 1u << 1,       ///< histories of denoisers and antialiasing
  structure = 1u << 2,     ///< the list of passes, and with it every history
};

constexpr ResetScope operator|(ResetScope a, ResetScope b) {
  return static_cast<ResetScope>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}
constexpr ResetScope& operator|=(ResetScope& a, ResetScope b) {
  return a = a | b;
}
/// Whether `scope` contains every history of `part`.
constexpr bool includes(ResetScope scope, ResetScope part) {
  const auto bits = static_cast<std::uint32_t>(part);
  return (static_cast<std::uint32_t>(scope) & bits) == bits;
}

enum class SettingType { boolean, integer, number, choice, text, color };

/// Range of a number, or of the number of characters of a text. Both ends are allowed.
struct SettingLimits {
  double minimum = 0.0;
  double maximum = 0.0;
};

/// One line of settings.def as data.
struct SettingDescriptor {
  std::string_view path;   ///< "tone_map.curve"
  std::string_view group;  ///< "tone_map"
  std::string_view name;   ///< "curve"
  SettingType type;
  std::variant<bool, int, float, std::string> initial;  ///< of choices and colors: text
  SettingLimits limits;                                 ///< of integers, numbers and texts
  std::span<const std::string_view> choices;            ///< of choices; otherwise empty
  std::string_view unit;                                ///< empty: dimensionless
  ResetScope resets;
  std::string_view help;
};

struct SettingGroup {
  std::string_view path;
  std::string_view title;
};

/// All settings in the order of settings.def.
std::span<const SettingDescriptor> setting_descriptors();
/// All groups in the order of settings.def.
std::span<const SettingGroup> setting_groups();
/// The setting at `path`, or null.
const SettingDescriptor* find_setting(std::string_view path);
/// The names of the histories in `scope`.
std::vector<std::string_view> scope_names(ResetScope scope);

/// Calls `visitor(descriptor, value)` for every setting in order; `value` is a reference to the
/// member (bool, int, float, std::string, Color or an enum class), const if `settings` is.
template <class SettingsType, class Visitor>
void visit_settings(SettingsType& settings, Visitor&& visitor) {
  const SettingDescriptor* descriptor = setting_descriptors().data();
#define SETTING(group, name, type, initial, limits, unit, resets, help) \
  visitor(*descriptor++, settings.group.name);
#include "protocol/settings/settings.def"
}

/// The histories that a change of settings from `before` to `after` invalidates.
ResetScope changed_scope(const Settings& before, const Settings& after);

/// Applies one "path=value" of the command line. On error (unknown path, wrong type, out of range)
/// nothing changes; the message names the path and the limit, or the nearest path that exists.
Result<void> set_by_path(Settings& settings, std::string_view assignment);

/// The reference page of all settings as Markdown.
std::string settings_markdown();

}  // namespace heliograph::protocol
