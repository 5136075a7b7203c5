#include "tests/paper/cases.hpp"

#include <array>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "protocol/settings/presets.hpp"
#include "protocol/settings/settings_json.hpp"

namespace heliograph::paper {
namespace {

constexpr std::array<std::string_view, 3> movement_names = {"static", "moving_camera",
                                                            "moving_objects_light"};
constexpr std::array<std::string_view, 3> other_rectifications = {"fast_history", "percentile",
                                                                  "gradient"};

void apply(protocol::Settings& settings, const nlohmann::json& patch) {
  const auto applied = protocol::apply_patch(settings, patch);
  if (!applied) throw std::logic_error(applied.error().message);
}

}  // namespace

std::string_view name(Movement movement) {
  return movement_names[static_cast<std::size_t>(movement)];
}

Movement parse_movement(std::string_view text) {
  for (std::size_t i = 0; i < movement_names.size(); ++i) {
    if (movement_names[i] == text) return static_cast<Movement>(i);
  }
  throw std::invalid_argument("no movement is called " + std::string(text));
}

std::string_view name(Swept swept) {
  return swept == Swept::roughness ? "roughness" : "angle";
}

Swept swept_in(std::string_view scene) {
  for (const std::string_view shadows : {"shadow_objects", "pillars", "breakfast_room"}) {
    if (scene == shadows) return Swept::angle;
  }
  for (const std::string_view reflections :
       {"cubes_distance", "icosphere", "glossy_sponza_1", "glossy_sponza_2", "glossy_sponza_3"}) {
    if (scene == reflections) return Swept::roughness;
  }
  throw std::invalid_argument("no scene of the paper is called " + std::string(scene));
}

std::span<const float> paper_values(Swept swept) {
  static constexpr float roughness[] = {0.0f, 0.1f, 0.2f, 0.3f, 0.4f, 0.6f, 1.0f};
  static constexpr float angle[] = {0.0f, 0.5f, 1.0f, 2.0f, 4.0f, 6.0f, 8.0f, 10.0f, 12.0f};
  if (swept == Swept::roughness) return roughness;
  return angle;
}

scenes::Sweep sweep_to(Swept swept, float value) {
  scenes::Sweep sweep;
  (swept == Swept::roughness ? sweep.roughness : sweep.shadow_angle) = value;
  return sweep;
}

protocol::Settings Technique::settings(Paths paths) const {
  protocol::Settings settings;
  const auto preset = protocol::find_preset(name);
  if (preset) {
    apply(settings, preset->settings.value());
  } else {
    apply(settings, protocol::find_preset("separable")->settings.value());
    apply(settings, {{"shadow_temporal", {{"rectification", name}}},
                     {"specular_temporal", {{"rectification", name}}}});
  }
  settings.indirect.enabled = settings.indirect.enabled && paths == Paths::all;
  settings.accumulation.enabled = false;
  settings.motion.scale = 1.0f;
  return settings;
}

const std::vector<Technique>& techniques() {
  static const std::vector<Technique> all = [] {
    std::vector<Technique> list;
    for (const protocol::Preset& preset : protocol::presets()) {
      list.push_back({std::string(preset.name)});
    }
    for (const std::string_view rectification : other_rectifications) {
      list.push_back({std::string(rectification)});
    }
    return list;
  }();
  return all;
}

const Technique& find_technique(std::string_view wanted) {
  for (const Technique& technique : techniques()) {
    if (technique.name == wanted) return technique;
  }
  throw std::invalid_argument("no preset is called " + std::string(wanted));
}

}  // namespace heliograph::paper
