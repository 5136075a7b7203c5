#include "protocol/settings/settings.hpp"

#include <array>
#include <charconv>
#include <nlohmann/json.hpp>
#include <type_traits>
#include <vector>

#include "protocol/json/suggestions.hpp"
#include "protocol/limits.hpp"
#include "protocol/settings/settings_json.hpp"

namespace heliograph::protocol {
namespace {

constexpr std::array<std::string_view, 3> reset_names{"accumulation", "history", "structure"};

// The limits of settings.def.
constexpr SettingLimits any{};
constexpr SettingLimits range(double minimum, double maximum) {
  return {minimum, maximum};
}
constexpr SettingLimits name_length(double minimum, double maximum) {
  return {minimum, maximum};
}

template <class Value>
SettingDescriptor describe(std::string_view path, std::string_view group, std::string_view name,
                           const Value& initial, SettingLimits limits, std::string_view unit,
                           ResetScope resets, std::string_view help) {
  SettingDescriptor result{path, group,  name, SettingType::boolean, {}, limits, {},
                           unit, resets, help};
  if constexpr (std::is_enum_v<Value>) {
    result.type = SettingType::choice;
    result.initial = std::string(enum_name(initial));
    result.choices = enum_names<Value>();
  } else if constexpr (std::is_same_v<Value, Color>) {
    result.type = SettingType::color;
    result.initial = color_text(initial);
  } else {
    if constexpr (std::is_same_v<Value, int>) result.type = SettingType::integer;
    if constexpr (std::is_same_v<Value, float>) result.type = SettingType::number;
    if constexpr (std::is_same_v<Value, std::string>) result.type = SettingType::text;
    result.initial = initial;
  }
  return result;
}

std::vector<SettingDescriptor> make_descriptors() {
  using enum ResetScope;
  const Settings initial_settings;
  return {
#define SETTING(group, name, type, initial, limits, unit, resets, help)                        \
  describe(#group "." #name, #group, #name, initial_settings.group.name, limits, unit, resets, \
           help),
#include "protocol/settings/settings.def"
  };
}

/// The value of a text of the command line. A text that does not fit the type stays a string, which
/// the check of the type refuses with its usual message.
nlohmann::json value_of(std::string_view text, SettingType type) {
  if (type == SettingType::boolean) {
    if (text == "true" || text == "on") return true;
    if (text == "false" || text == "off") return false;
  }
  if (type == SettingType::integer || type == SettingType::number) {
    double number = 0.0;
    const auto parsed = std::from_chars(text.data(), text.data() + text.size(), number);
    if (parsed.ec == std::errc() && parsed.ptr == text.data() + text.size()) return number;
  }
  return text;
}

Error unknown_path(std::string_view path) {
  std::vector<std::string_view> paths;
  std::string members;
  for (const SettingDescriptor& setting : setting_descriptors()) {
    paths.push_back(setting.path);
    if (setting.group != path) continue;
    members += members.empty() ? "" : ", ";
    members += setting.path;
  }
  if (!members.empty()) {
    return error::invalid(std::string(path), "is a group of settings", members);
  }
  return error::invalid(std::string(path), "unknown setting" + suggestion(path, paths));
}

}  // namespace

std::span<const SettingDescriptor> setting_descriptors() {
  static const std::vector<SettingDescriptor> descriptors = make_descriptors();
  return descriptors;
}

std::span<const SettingGroup> setting_groups() {
  static constexpr auto groups = std::to_array<SettingGroup>({
#define GROUP(path, Type, title) {#path, title},
#include "protocol/settings/settings.def"
  });
  return groups;
}

const SettingDescriptor* find_setting(std::string_view path) {
  for (const SettingDescriptor& setting : setting_descriptors()) {
    if (setting.path == path) return &setting;
  }
  return nullptr;
}

std::vector<std::string_view> scope_names(ResetScope scope) {
  std::vector<std::string_view> names;
  for (std::size_t bit = 0; bit < reset_names.size(); ++bit) {
    if (includes(scope, static_cast<ResetScope>(1u << bit))) names.push_back(reset_names[bit]);
  }
  return names;
}

ResetScope changed_scope(const Settings& before, const Settings& after) {
  using enum ResetScope;
  ResetScope scope = none;
#define SETTING(group, name, type, initial, limits, unit, resets, help) \
  if (before.group.name != after.group.name) scope |= resets;
#include "protocol/settings/settings.def"
  return scope;
}

Result<void> set_by_path(Settings& settings, std::string_view assignment) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string_view::npos || equals == 0) {
    return error::invalid(std::string(assignment), "must look like path=value",
                          "for example tone_map.curve=aces");
  }
  const std::string_view path = assignment.substr(0, equals);
  const SettingDescriptor* setting = find_setting(path);
  if (setting == nullptr) return unknown_path(path);
  return assign_setting(settings, *setting, value_of(assignment.substr(equals + 1), setting->type));
}

}  // namespace heliograph::protocol
