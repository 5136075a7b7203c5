#include "protocol/settings/presets.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "protocol/json/suggestions.hpp"
#include "protocol/settings/embedded_presets.hpp"
#include "protocol/settings/settings.hpp"

namespace heliograph::protocol {
namespace {

using nlohmann::json;

struct Description {
  std::string_view name;
  std::string_view text;
};

constexpr std::array<Description, 6> descriptions = {{
    {"svgf",
     "Spatiotemporal variance-guided filtering of shadows and reflections (SVGF, Schied et al. "
     "2017): the paper's baseline."},
    {"rectification",
     "svgf, with the history clamped to mean and variance of 3x3 pixels (paper section 3.1): no "
     "ghosting, more noise."},
    {"adapted",
     "rectification, with a blur that starts one level wider on rough surfaces and under large "
     "lights (paper section 3.2)."},
    {"separable",
     "adapted, with the blur as two passes of 5 neighbours instead of one of 25 (paper section "
     "3.3)."},
    {"reinhard",
     "separable, with reflections compressed before denoising (paper section 3.4): the complete "
     "paper."},
    {"best",
     "The default: long histories for static lights and geometry, virtual motion of reflections, "
     "no banding."},
}};

// Every preset resets these groups and settings before it sets its own.
constexpr std::array denoiser = std::to_array<std::string_view>({"reprojection",
                                                                 "shadow_temporal",
                                                                 "shadow_blur",
                                                                 "specular_temporal",
                                                                 "specular_blur",
                                                                 "reinhard",
                                                                 "specular.enabled",
                                                                 "specular.hit_shading",
                                                                 "specular.max_roughness",
                                                                 "specular.fade_start",
                                                                 "specular.fade_end",
                                                                 "specular.fade_fraction",
                                                                 "specular.fade_to",
                                                                 "specular.reuse_shadows",
                                                                 "sampling.visibility",
                                                                 "sampling.specular",
                                                                 "sampling.full_frames",
                                                                 "sampling.floor",
                                                                 "accumulation.by_noise",
                                                                 "accumulation.filter",
                                                                 "antialiasing.temporal",
                                                                 "indirect",
                                                                 "indirect_temporal",
                                                                 "indirect_blur"});

/// A patch that resets the denoiser, flattened: null at "/group/name" of each setting.
json flat_reset() {
  json reset = json::object();
  for (const SettingDescriptor& setting : setting_descriptors()) {
    const auto is_it = [&](std::string_view path) {
      return path == setting.group || path == setting.path;
    };
    if (std::none_of(denoiser.begin(), denoiser.end(), is_it)) continue;
    reset["/" + std::string(setting.group) + "/" + std::string(setting.name)] = nullptr;
  }
  return reset;
}

/// The settings of scenes/presets/NAME.json on top of those of the preset that it extends.
json settings_of(std::string_view name) {
  json own = json::parse(embedded_preset(name));
  const std::string extended = own.value("extends", "");
  own.erase("extends");
  if (extended.empty()) return own;
  json all = settings_of(extended);
  all.merge_patch(own);
  return all;
}

RawJson patch_of(std::string_view name) {
  json flat = flat_reset();
  const json settings = settings_of(name);
  if (!settings.empty()) flat.update(settings.flatten());
  return RawJson(flat.unflatten());
}

}  // namespace

std::span<const Preset> presets() {
  static const std::vector<Preset> all = [] {
    std::vector<Preset> list;
    for (const Description& preset : descriptions) {
      list.push_back({preset.name, preset.text, patch_of(preset.name)});
    }
    return list;
  }();
  return all;
}

Result<Preset> find_preset(std::string_view name) {
  std::vector<std::string_view> names;
  for (const Preset& preset : presets()) {
    if (preset.name == name) return preset;
    names.push_back(preset.name);
  }
  return error::not_found("name", "there is no such preset" + suggestion(name, names));
}

}  // namespace heliograph::protocol
