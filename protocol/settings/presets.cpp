#include "protocol/settings/presets.hpp"

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "protocol/json/suggestions.hpp"
#include "protocol/settings/embedded_presets.hpp"

namespace heliograph::protocol {
namespace {

struct Description {
  std::string_view name;
  std::string_view text;
};

constexpr std::array<Description, 6> descriptions = {{
    {"svgf",
     "Spatiotemporal variance-guided filtering of both channels (Schied et al. 2017): the paper's "
     "baseline."},
    {"rectification",
     "svgf, and history is clamped to mean and variance of 3x3 pixels (paper section 3.1): no "
     "ghosts, more noise."},
    {"adapted",
     "rectification, and the blur starts a scale wider on rough surfaces and under large lights "
     "(paper section 3.2)."},
    {"separable",
     "adapted, with the blur as two passes of 5 neighbours in place of one of 25 (paper section "
     "3.3)."},
    {"reinhard",
     "separable, and reflections are compressed before denoising (paper section 3.4): all of the "
     "paper."},
    {"best",
     "The best that Heliograph can do: histories as long as lights and things rest, reflections "
     "followed behind their mirror, no bands."},
}};

}  // namespace

std::span<const Preset> presets() {
  static const std::vector<Preset> all = [] {
    std::vector<Preset> list;
    for (const Description& preset : descriptions) {
      list.push_back(
          {preset.name, preset.text, RawJson(nlohmann::json::parse(embedded_preset(preset.name)))});
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
  return error::not_found("name", "is no preset" + suggestion(name, names));
}

}  // namespace heliograph::protocol
