#include <nlohmann/json.hpp>
#include <sstream>

#include "protocol/json/json_values.hpp"
#include "protocol/settings/settings.hpp"

namespace heliograph::protocol {
namespace {

std::string initial_text(const SettingDescriptor& setting) {
  struct Text {
    std::string operator()(bool value) const { return value ? "true" : "false"; }
    std::string operator()(int value) const { return std::to_string(value); }
    std::string operator()(float value) const { return number_text(shortest(value)); }
    std::string operator()(const std::string& value) const { return value; }
  };
  return std::visit(Text{}, setting.initial);
}

std::string values_text(const SettingDescriptor& setting) {
  const std::string range = range_text({setting.limits.minimum, setting.limits.maximum});
  const std::string unit = setting.unit.empty() ? "" : " " + std::string(setting.unit);
  switch (setting.type) {
    case SettingType::boolean:
      return "true, false";
    case SettingType::integer:
      return "integer, " + range + unit;
    case SettingType::number:
      return range + unit;
    case SettingType::choice:
      return choices_text(setting.choices);
    case SettingType::text:
      return "name of " + range + " characters";
    case SettingType::color:
      return "#rrggbb";
  }
  return {};
}

std::string resets_text(const SettingDescriptor& setting) {
  std::string text;
  for (const std::string_view name : scope_names(setting.resets)) {
    text += (text.empty() ? "" : ", ") + std::string(name);
  }
  return text.empty() ? "nothing" : text;
}

}  // namespace

std::string settings_markdown() {
  std::ostringstream page;
  page << "# Settings\n\nGenerated from `protocol/settings/settings.def`. Set one with "
          "`--set path=value` or the method `settings.patch`; null resets it.\n";
  for (const SettingGroup& group : setting_groups()) {
    page << "\n## " << group.title << "\n\n"
         << "| setting | default | values | resets | description |\n|---|---|---|---|---|\n";
    for (const SettingDescriptor& setting : setting_descriptors()) {
      if (setting.group != group.path) continue;
      page << "| `" << setting.path << "` | " << initial_text(setting) << " | "
           << values_text(setting) << " | " << resets_text(setting) << " | " << setting.help
           << " |\n";
    }
  }
  return page.str();
}

}  // namespace heliograph::protocol
