#include "protocol/presets.hpp"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "protocol/embedded_presets.hpp"
#include "protocol/suggestions.hpp"

namespace heliograph::protocol {
namespace {

std::vector<Preset> parse_presets() {
  // Views into the descriptions must stay valid: the documents live as long as the program.
  static const std::vector<nlohmann::json> documents = [] {
    std::vector<nlohmann::json> all;
    for (const EmbeddedPreset& file : embedded_presets()) {
      all.push_back(nlohmann::json::parse(file.text));
    }
    return all;
  }();
  std::vector<Preset> list;
  for (std::size_t i = 0; i < documents.size(); ++i) {
    const nlohmann::json& document = documents[i];
    list.push_back({embedded_presets()[i].name,
                    document.at("description").get_ref<const std::string&>(),
                    RawJson(document.at("settings"))});
  }
  return list;
}

}  // namespace

std::span<const Preset> presets() {
  static const std::vector<Preset> all = parse_presets();
  return all;
}

Result<Preset> find_preset(std::string_view name) {
  std::vector<std::string_view> names;
  for (const Preset& preset : presets()) {
    if (preset.name == name) return preset;
    names.push_back(preset.name);
  }
  return error::not_found("name", "is no preset" + suggestion(name, names));
}

}  // namespace heliograph::protocol
