#include "protocol/settings/presets.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "protocol/settings/settings_json.hpp"

namespace heliograph::protocol {
namespace {

using nlohmann::json;

json flat(const Preset& preset) {
  return preset.settings.value().flatten();
}

std::set<std::string> paths(const Preset& preset) {
  const json tree = flat(preset);
  std::set<std::string> all;
  for (const auto& [path, value] : tree.items()) all.insert(path);
  return all;
}

std::set<std::string> paths_that_differ(const json& before, const json& after) {
  std::set<std::string> different;
  for (const auto& [path, value] : after.items()) {
    if (before.at(path) != value) different.insert(path);
  }
  return different;
}

std::set<std::string> in_both_channels(const std::string& stage, const std::string& name) {
  return {"/shadow_" + stage + "/" + name, "/specular_" + stage + "/" + name};
}

std::set<std::string> operator+(std::set<std::string> a, const std::set<std::string>& b) {
  a.insert(b.begin(), b.end());
  return a;
}

TEST(Presets, AreThePapersLadderAndTheBest) {
  std::vector<std::string_view> names;
  for (const Preset& preset : presets()) {
    names.push_back(preset.name);
    EXPECT_FALSE(preset.description.empty()) << preset.name;
  }
  EXPECT_EQ(names, (std::vector<std::string_view>{"svgf", "rectification", "adapted", "separable",
                                                  "reinhard", "best"}));
}

TEST(Presets, AreAllTheFilesOfTheirFolder) {
  const auto folder = std::filesystem::path(__FILE__).parent_path() / "../../../scenes/presets";
  std::set<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    files.insert(entry.path().stem().string());
  }
  std::set<std::string> embedded;
  for (const Preset& preset : presets()) embedded.insert(std::string(preset.name));
  EXPECT_EQ(embedded, files);
}

TEST(Presets, FitTheSettings) {
  for (const Preset& preset : presets()) {
    Settings settings;
    const auto applied = apply_patch(settings, preset.settings.value());
    EXPECT_TRUE(applied) << preset.name << ": " << applied.error().message;
  }
}

// Whoever goes from one preset to another must not keep anything of the first.
TEST(Presets, NameTheSameSettings) {
  const std::set<std::string> expected = paths(presets().front());
  for (const Preset& preset : presets()) EXPECT_EQ(paths(preset), expected) << preset.name;
}

TEST(Presets, EachRungAddsItsOwnTechniqueAlone) {
  const std::map<std::string_view, std::set<std::string>> additions = {
      {"rectification", in_both_channels("temporal", "rectification")},
      {"adapted", in_both_channels("blur", "adapt_start")},
      {"separable",
       in_both_channels("blur", "kernel") + in_both_channels("blur", "variance_update")},
      {"reinhard", {"/reinhard/mode"}}};
  for (std::size_t i = 1; i + 1 < presets().size(); ++i) {
    EXPECT_EQ(paths_that_differ(flat(presets()[i - 1]), flat(presets()[i])),
              additions.at(presets()[i].name))
        << presets()[i].name;
  }
}

TEST(Presets, TheBestIsWhatHoldsWithoutAPreset) {
  Settings settings;
  ASSERT_TRUE(apply_patch(settings, find_preset("best")->settings.value()));
  EXPECT_EQ(settings, Settings()) << difference(Settings(), settings).dump();
}

TEST(Presets, AnUnknownNameIsRefusedWithTheNearest) {
  const Result<Preset> found = find_preset("reinhart");
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, ErrorCode::not_found);
  EXPECT_EQ(found.error().path, "name");
  EXPECT_NE(found.error().message.find("reinhard"), std::string::npos);
}

}  // namespace
}  // namespace heliograph::protocol
