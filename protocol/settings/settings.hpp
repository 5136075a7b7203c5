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

namespace heliograph::protocol {

#define CHOICE(Type, ...) HELIOGRAPH_ENUM(Type, __VA_ARGS__)
#include "protocol/settings/settings.def"

/// What the renderer is asked to do. Groups and members are the lines of settings.def:
/// `settings.tone_map.curve`. Values set through this library are always within their limits.
struct Settings {
#define GROUP(path, Type, title) \
  struct Type {                  \
    bool operator==(const Type&) const = default;
#define SETTING(group, name, type, initial, limits, unit, resets, help) type name = initial;
#define END_GROUP(name) \
  }                     \
  name;
#include "protocol/settings/settings.def"

  bool operator==(const Settings&) const = default;
};

/// Histories that a changed setting makes worthless, as a bit mask.
enum class ResetScope : std::uint32_t {
  none = 0,
  accumulation = 1u << 0,  ///< the mean over a resting picture
  history = 1u << 1,       ///< what denoisers and antialiasing carry from frame to frame
  structure = 1u << 2,     ///< the frame's list of passes, and with it every history
};

constexpr ResetScope operator|(ResetScope a, ResetScope b) {
  return static_cast<ResetScope>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}
constexpr ResetScope& operator|=(ResetScope& a, ResetScope b) {
  return a = a | b;
}
/// Whether `scope` holds every history of `part`.
constexpr bool includes(ResetScope scope, ResetScope part) {
  const auto bits = static_cast<std::uint32_t>(part);
  return (static_cast<std::uint32_t>(scope) & bits) == bits;
}

enum class SettingType { boolean, integer, number, choice, text };

/// Numbers lie within [minimum, maximum]; texts have so many characters. Both ends count.
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
  std::variant<bool, int, float, std::string> initial;  ///< a choice's is its name
  SettingLimits limits;                                 ///< of integers, numbers and texts
  std::span<const std::string_view> choices;            ///< of choices, else empty
  std::string_view unit;                                ///< empty: a plain number
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
/// The setting called `path`, or null.
const SettingDescriptor* find_setting(std::string_view path);
/// The names of the histories in `scope`.
std::vector<std::string_view> scope_names(ResetScope scope);

/// Calls `visitor(descriptor, value)` for every setting in order; `value` is a reference to the
/// member (bool, int, float, std::string or an enum class), const if `settings` is.
template <class SettingsType, class Visitor>
void visit_settings(SettingsType& settings, Visitor&& visitor) {
  const SettingDescriptor* descriptor = setting_descriptors().data();
#define SETTING(group, name, type, initial, limits, unit, resets, help) \
  visitor(*descriptor++, settings.group.name);
#include "protocol/settings/settings.def"
}

/// The histories that must be dropped when settings change from `before` to `after`.
ResetScope changed_scope(const Settings& before, const Settings& after);

/// Applies one "path=value" of the command line. On error (unknown path, wrong type, out of range)
/// nothing changes and the message names the path, the limit and, for unknown paths, the nearest.
Result<void> set_by_path(Settings& settings, std::string_view assignment);

/// The reference page of all settings as Markdown, made from settings.def.
std::string settings_markdown();

}  // namespace heliograph::protocol
