#include "protocol/settings/presets.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <type_traits>
#include <vector>

#include "protocol/settings/settings_json.hpp"

namespace heliograph::protocol {
namespace {

using nlohmann::json;

Settings with_preset(const Preset& preset, Settings settings = {}) {
  const auto applied = apply_patch(settings, preset.settings.value());
  EXPECT_TRUE(applied) << preset.name << ": " << applied.error().message;
  return settings;
}

/// Paths such as "/shadow_blur/kernel" of the settings whose values differ.
std::set<std::string> changed_paths(const Settings& before, const Settings& after) {
  std::set<std::string> paths;
  const json patch = difference(before, after).flatten();
  for (const auto& [path, value] : patch.items()) paths.insert(path);
  return paths;
}

std::set<std::string> in_both_channels(const std::string& stage, const std::string& name) {
  return {"/shadow_" + stage + "/" + name, "/specular_" + stage + "/" + name};
}

std::set<std::string> operator+(std::set<std::string> a, const std::set<std::string>& b) {
  a.insert(b.begin(), b.end());
  return a;
}

/// Settings of which each one has another value than its default.
Settings all_changed() {
  Settings settings;
  visit_settings(settings, [](const SettingDescriptor& setting, auto& value) {
    using Value = std::remove_reference_t<decltype(value)>;
    const SettingLimits& limits = setting.limits;
    if constexpr (std::is_same_v<Value, bool>) {
      value = !value;
    } else if constexpr (std::is_enum_v<Value>) {
      const auto next = static_cast<std::size_t>(value) + 1;
      value = static_cast<Value>(next % setting.choices.size());
    } else if constexpr (std::is_same_v<Value, std::string>) {
      value += "2";
    } else if constexpr (std::is_same_v<Value, Color>) {
      value.rgb ^= 0xffffffu;
    } else {
      value = static_cast<Value>(value == static_cast<Value>(limits.maximum) ? limits.minimum
                                                                             : limits.maximum);
    }
  });
  return settings;
}

bool is_of_the_denoiser(const SettingDescriptor& setting) {
  static const std::set<std::string_view> groups{
      "reprojection", "shadow_temporal", "shadow_blur",       "specular_temporal", "specular_blur",
      "reinhard",     "indirect",        "indirect_temporal", "indirect_blur"};
  static const std::set<std::string_view> paths{
      "specular.enabled",      "specular.hit_shading",   "specular.max_roughness",
      "specular.fade_start",   "specular.fade_end",      "specular.fade_fraction",
      "specular.fade_to",      "specular.reuse_shadows", "sampling.visibility",
      "sampling.specular",     "sampling.full_frames",   "sampling.floor",
      "accumulation.by_noise", "accumulation.filter",    "antialiasing.temporal"};
  return groups.contains(setting.group) || paths.contains(setting.path);
}

TEST(Presets, AreThePapersStepsAndTheBest) {
  std::vector<std::string_view> names;
  for (const Preset& preset : presets()) {
    names.push_back(preset.name);
    EXPECT_FALSE(preset.description.empty()) << preset.name;
  }
  EXPECT_EQ(names, (std::vector<std::string_view>{"svgf", "rectification", "adapted", "separable",
                                                  "reinhard", "best"}));
}

TEST(Presets, EmbedAllFilesOfTheFolder) {
  const auto folder = std::filesystem::path(HELIOGRAPH_SOURCE_DIR) / "scenes/presets";
  std::set<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    files.insert(entry.path().stem().string());
  }
  std::set<std::string> embedded;
  for (const Preset& preset : presets()) embedded.insert(std::string(preset.name));
  EXPECT_EQ(embedded, files);
}

TEST(Presets, ResetTheDenoiserAndNothingElse) {
  const Settings changed = all_changed();
  for (const Preset& preset : presets()) {
    const json from_defaults = to_json(with_preset(preset));
    const json after = to_json(with_preset(preset, changed));
    const json before = to_json(changed);
    ASSERT_EQ(changed_paths(Settings(), changed).size(), setting_descriptors().size());
    for (const SettingDescriptor& setting : setting_descriptors()) {
      const json& expected = is_of_the_denoiser(setting) ? from_defaults : before;
      const json::json_pointer path("/" + std::string(setting.group) + "/" +
                                    std::string(setting.name));
      EXPECT_EQ(after.at(path), expected.at(path)) << preset.name << " " << setting.path;
    }
  }
}

TEST(Presets, EachStepOfThePaperAddsOnlyItsOwnTechnique) {
  const std::map<std::string_view, std::set<std::string>> additions = {
      {"rectification", in_both_channels("temporal", "rectification")},
      {"adapted", in_both_channels("blur", "adapt_start")},
      {"separable",
       in_both_channels("blur", "kernel") + in_both_channels("blur", "variance_update")},
      {"reinhard", {"/reinhard/mode"}}};
  for (std::size_t i = 1; i + 1 < presets().size(); ++i) {
    EXPECT_EQ(changed_paths(with_preset(presets()[i - 1]), with_preset(presets()[i])),
              additions.at(presets()[i].name))
        << presets()[i].name;
  }
}

TEST(Presets, SvgfIsThePapersBaseline) {
  const Settings svgf = with_preset(*find_preset("svgf"));
  EXPECT_EQ(difference(Settings(), svgf), json::parse(R"({
    "shadow_temporal": {"history_seconds": 0.0, "history_frames": 20, "follow_lights": false,
                        "rectification": "off", "rectification_scale": 1.0,
                        "mean_variance": false, "bicubic": false},
    "shadow_blur": {"kernel": "full", "feedback": 0, "jitter": false, "iterations": 4,
                    "luminance_sigma": 4.0, "moving_sigma": 4.0},
    "specular_temporal": {"history_seconds": 0.0, "history_frames": 20, "follow_lights": false,
                          "rectification": "off", "rectification_radius": 1,
                          "rectification_scale": 1.0, "mean_variance": false, "bicubic": false,
                          "virtual_motion": false, "curved_reflectors": false},
    "specular_blur": {"kernel": "full", "feedback": 0, "jitter": false, "lobe_limit": false,
                      "iterations_by_roughness": false, "iterations": 4, "luminance_sigma": 4.0,
                      "moving_sigma": 4.0},
    "accumulation": {"by_noise": false},
    "indirect": {"enabled": false},
    "sampling": {"visibility": false, "specular": false}})"));
}

TEST(Presets, StepsOfThePaperTraceOneSamplePerPixel) {
  for (const Preset& preset : presets()) {
    const Settings settings = with_preset(preset, all_changed());
    const bool is_best = preset.name == "best";
    EXPECT_EQ(settings.sampling.visibility, is_best) << preset.name;
    EXPECT_EQ(settings.sampling.specular, is_best) << preset.name;
  }
}

TEST(Presets, BestIsTheDefaults) {
  const Settings best = with_preset(*find_preset("best"));
  EXPECT_EQ(best, Settings()) << difference(Settings(), best).dump();
}

TEST(Presets, UnknownNameIsRefusedWithTheNearest) {
  const Result<Preset> found = find_preset("reinhart");
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, ErrorCode::not_found);
  EXPECT_EQ(found.error().path, "name");
  EXPECT_NE(found.error().message.find("reinhard"), std::string::npos);
}

}  // namespace
}  // namespace heliograph::protocol
