#include "protocol/settings/settings_json.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>
#include <vector>

#include "protocol/json/json_values.hpp"
#include "protocol/json/suggestions.hpp"

namespace heliograph::protocol {
namespace {

using nlohmann::json;

json json_of(bool value) {
  return value;
}
json json_of(int value) {
  return value;
}
json json_of(float value) {
  return shortest(value);
}
json json_of(const std::string& value) {
  return value;
}
json json_of(Color value) {
  return color_text(value);
}
template <class Enum>
requires std::is_enum_v<Enum> json json_of(Enum value) {
  return enum_name(value);
}

json initial_of(const SettingDescriptor& setting) {
  return std::visit([](const auto& value) { return json_of(value); }, setting.initial);
}

/// The node "a.b.c" of a tree; creates missing objects.
json& at_path(json& tree, std::string_view path) {
  json* node = &tree;
  while (true) {
    const std::size_t dot = std::min(path.find('.'), path.size());
    node = &(*node)[std::string(path.substr(0, dot))];
    if (dot == path.size()) return *node;
    path.remove_prefix(dot + 1);
  }
}

NumberRange range_of(const SettingDescriptor& setting) {
  return {setting.limits.minimum, setting.limits.maximum};
}

/// Buffer names are identifiers, which also keeps strings that are not UTF-8 out of the tree.
constexpr std::string_view name_characters =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_.-";

Result<void> read(const json& value, const SettingDescriptor& setting, bool& out) {
  const Result<bool> flag = read_boolean(value, std::string(setting.path));
  if (!flag) return flag.error();
  out = *flag;
  return {};
}

Result<void> read(const json& value, const SettingDescriptor& setting, int& out) {
  const auto number = read_integer(value, std::string(setting.path), range_of(setting));
  if (!number) return number.error();
  out = static_cast<int>(*number);
  return {};
}

Result<void> read(const json& value, const SettingDescriptor& setting, float& out) {
  const auto number = read_number(value, std::string(setting.path), range_of(setting));
  if (!number) return number.error();
  out = static_cast<float>(*number);
  return {};
}

Result<void> read(const json& value, const SettingDescriptor& setting, std::string& out) {
  const Result<std::string> text = read_text(value, std::string(setting.path));
  if (!text) return text.error();
  const auto length = static_cast<double>(text->size());
  if (length < setting.limits.minimum || length > setting.limits.maximum ||
      text->find_first_not_of(name_characters) != std::string::npos) {
    return error::invalid(std::string(setting.path), "is not a valid name",
                          range_text(range_of(setting)) + " characters of A-Z a-z 0-9 _ . -");
  }
  out = *text;
  return {};
}

Result<void> read(const json& value, const SettingDescriptor& setting, Color& out) {
  const Result<std::string> text = read_text(value, std::string(setting.path));
  if (!text) return text.error();
  const std::optional<Color> color = parse_color(*text);
  if (!color) {
    return error::invalid(std::string(setting.path), "is not a color", "#rrggbb, hexadecimal");
  }
  out = *color;
  return {};
}

template <class Enum>
requires std::is_enum_v<Enum> Result<void> read(const json& value, const SettingDescriptor& setting,
                                                Enum& out) {
  const auto index = read_choice(value, std::string(setting.path), setting.choices);
  if (!index) return index.error();
  out = static_cast<Enum>(*index);
  return {};
}

struct Edit {
  const SettingDescriptor* setting;
  const json* value;
};

bool is_group(std::string_view path) {
  const auto groups = setting_groups();
  return std::any_of(groups.begin(), groups.end(), [&](const SettingGroup& group) {
    return group.path == path || group.path.starts_with(std::string(path) + ".");
  });
}

Error unknown_member(const std::string& path, std::string_view key) {
  std::vector<std::string_view> known;
  for (const SettingGroup& group : setting_groups()) known.push_back(group.path);
  for (const SettingDescriptor& setting : setting_descriptors()) known.push_back(setting.path);
  if (key.find('.') != std::string_view::npos) {
    return error::invalid(path, "unknown setting; groups are nested objects, not dotted names");
  }
  return error::invalid(path, "unknown setting" + suggestion(path, known));
}

/// Turns the patch, an object at the group `prefix`, into a list of edits. The depth of recursion
/// is limited by the groups of settings.def, whatever the depth of the patch.
Result<void> collect(const json& patch, const std::string& prefix, std::vector<Edit>& edits) {
  static const json null;
  for (const auto& [key, value] : patch.items()) {
    const std::string path = prefix.empty() ? key : prefix + "." + key;
    const bool plain_key = !key.empty() && key.find('.') == std::string::npos;
    const SettingDescriptor* setting = plain_key ? find_setting(path) : nullptr;
    if (setting != nullptr) {
      edits.push_back({setting, &value});
    } else if (!plain_key || !is_group(path)) {
      return unknown_member(path, key);
    } else if (value.is_null()) {
      for (const SettingDescriptor& member : setting_descriptors()) {
        if (member.path.starts_with(path + ".")) edits.push_back({&member, &null});
      }
    } else if (value.is_object()) {
      const Result<void> inner = collect(value, path, edits);
      if (!inner) return inner;
    } else {
      return error::invalid(path, "is a group of settings", "an object or null");
    }
  }
  return {};
}

json schema_of_leaf(const SettingDescriptor& setting, std::size_t order) {
  json leaf{{"default", initial_of(setting)},
            {"description", setting.help},
            {"x-resets", scope_names(setting.resets)},
            {"x-order", order}};
  if (!setting.unit.empty()) leaf["x-unit"] = setting.unit;
  const auto numbers = [&](const char* type, const char* low, const char* high) {
    leaf["type"] = type;
    if (setting.type == SettingType::number) {
      leaf[low] = setting.limits.minimum;
      leaf[high] = setting.limits.maximum;
    } else {
      leaf[low] = static_cast<std::int64_t>(setting.limits.minimum);
      leaf[high] = static_cast<std::int64_t>(setting.limits.maximum);
    }
  };
  switch (setting.type) {
    case SettingType::boolean:
      leaf["type"] = "boolean";
      break;
    case SettingType::integer:
      numbers("integer", "minimum", "maximum");
      break;
    case SettingType::number:
      numbers("number", "minimum", "maximum");
      break;
    case SettingType::choice:
      leaf["type"] = "string";
      leaf["enum"] = setting.choices;
      break;
    case SettingType::text:
      numbers("string", "minLength", "maxLength");
      leaf["pattern"] = "^[A-Za-z0-9_.-]+$";
      break;
    case SettingType::color:
      leaf["type"] = "string";
      leaf["format"] = "color";
      leaf["pattern"] = "^#?[0-9A-Fa-f]{6}$";
      break;
  }
  return leaf;
}

/// The schema of a setting or group: every step of its path goes through "properties".
json& schema_at(json& schema, std::string_view path) {
  json* node = &schema;
  while (!path.empty()) {
    const std::size_t dot = std::min(path.find('.'), path.size());
    node = &(*node)["properties"][std::string(path.substr(0, dot))];
    path.remove_prefix(std::min(dot + 1, path.size()));
  }
  return *node;
}

}  // namespace

json to_json(const Settings& settings) {
  json tree = json::object();
  visit_settings(settings, [&](const SettingDescriptor& setting, const auto& value) {
    at_path(tree, setting.path) = json_of(value);
  });
  return tree;
}

json difference(const Settings& before, const Settings& after) {
  json old_tree = to_json(before);
  json patch = json::object();
  visit_settings(after, [&](const SettingDescriptor& setting, const auto& value) {
    const json new_value = json_of(value);
    if (at_path(old_tree, setting.path) != new_value) at_path(patch, setting.path) = new_value;
  });
  return patch;
}

Result<void> assign_setting(Settings& settings, const SettingDescriptor& setting,
                            const json& value) {
  const json& effective = value.is_null() ? initial_of(setting) : value;
  Result<void> outcome;
  visit_settings(settings, [&](const SettingDescriptor& candidate, auto& member) {
    if (candidate.path == setting.path) outcome = read(effective, setting, member);
  });
  return outcome;
}

Result<json> apply_patch(Settings& settings, const json& patch) {
  if (!patch.is_object()) return error::invalid("patch", "must be an object");
  std::vector<Edit> edits;
  const Result<void> understood = collect(patch, "", edits);
  if (!understood) return understood.error();

  Settings changed = settings;
  json applied = json::object();
  for (const Edit& edit : edits) {
    const Result<void> assigned = assign_setting(changed, *edit.setting, *edit.value);
    if (!assigned) return assigned.error();
  }
  visit_settings(changed, [&](const SettingDescriptor& setting, const auto& value) {
    const bool mentioned = std::any_of(edits.begin(), edits.end(), [&](const Edit& edit) {
      return edit.setting->path == setting.path;
    });
    if (mentioned) at_path(applied, setting.path) = json_of(value);
  });
  settings = std::move(changed);
  return applied;
}

json settings_schema() {
  json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
              {"title", "Settings"},
              {"description", "The settings of the renderer."}};
  const auto describe_object = [](json& object) {
    object["type"] = "object";
    object["additionalProperties"] = false;
  };
  describe_object(schema);
  std::size_t order = 0;
  for (const SettingGroup& group : setting_groups()) {
    json& place = schema_at(schema, group.path);
    describe_object(place);
    place["title"] = group.title;
    place["x-order"] = order++;
  }
  order = 0;
  for (const SettingDescriptor& setting : setting_descriptors()) {
    schema_at(schema, setting.path) = schema_of_leaf(setting, order++);
  }
  return schema;
}

}  // namespace heliograph::protocol
