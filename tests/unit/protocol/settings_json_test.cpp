#include "protocol/settings/settings_json.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "protocol/json/json_values.hpp"

namespace heliograph::protocol {
namespace {

using nlohmann::json;

/// Settings that differ from the default in every member.
Settings everything_changed() {
  Settings settings;
  visit_settings(settings, [](const SettingDescriptor& setting, auto& value) {
    using Value = std::remove_reference_t<decltype(value)>;
    if constexpr (std::is_same_v<Value, bool>) {
      value = !value;
    } else if constexpr (std::is_same_v<Value, std::string>) {
      value = "other." + value;
    } else if constexpr (std::is_same_v<Value, Color>) {
      value.rgb ^= 0xffffffu;
    } else if constexpr (std::is_enum_v<Value>) {
      const auto last = static_cast<Value>(setting.choices.size() - 1);
      value = value == last ? Value{} : last;
    } else {
      const auto most = static_cast<Value>(setting.limits.maximum);
      value = value == most ? static_cast<Value>(setting.limits.minimum) : most;
    }
  });
  return settings;
}

TEST(SettingsJson, EverySettingSurvivesTheRoundTrip) {
  for (const Settings& original : {Settings{}, everything_changed()}) {
    Settings copy = original == Settings{} ? everything_changed() : Settings{};
    const json tree = to_json(original);
    const Result<json> applied = apply_patch(copy, json::parse(tree.dump()));
    ASSERT_TRUE(applied) << applied.error().message;
    EXPECT_EQ(copy, original);
    EXPECT_EQ(*applied, tree);
  }
}

TEST(SettingsJson, EverySettingIsInTheTreeAndNothingElse) {
  const json flat = to_json(everything_changed()).flatten();
  EXPECT_EQ(flat.size(), setting_descriptors().size());
  const json flat_initial = to_json(Settings{}).flatten();
  for (const auto& [pointer, value] : flat.items()) {
    EXPECT_NE(value, flat_initial.at(pointer)) << pointer;
  }
}

TEST(SettingsJson, FloatsAreWrittenInShortestForm) {
  Settings settings;
  settings.ambient.radius = 0.1f;
  EXPECT_EQ(to_json(settings)["ambient"].dump(), R"({"occlusion":true,"radius":0.1})");
}

TEST(SettingsJson, ShortestDecimalIsStillTheSameFloat) {
  std::mt19937 random(7);
  for (int i = 0; i < 100000; ++i) {
    const float value = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
    if (!std::isfinite(value)) continue;
    EXPECT_EQ(static_cast<float>(shortest(value)), value);
  }
}

TEST(SettingsJson, DifferenceIsThePatchBetweenTwoStates) {
  EXPECT_EQ(difference(Settings{}, Settings{}), json::object());
  Settings after;
  after.tone_map.curve = ToneMapCurve::agx;
  after.exposure.compensation = 2.0f;
  const json patch = difference(Settings{}, after);
  EXPECT_EQ(patch, json::parse(R"({"tone_map":{"curve":"agx"},"exposure":{"compensation":2}})"));
  Settings patched;
  ASSERT_TRUE(apply_patch(patched, patch));
  EXPECT_EQ(patched, after);
}

struct PatchCase {
  const char* before;
  const char* patch;
  const char* applied;
  const char* after;
};

void PrintTo(const PatchCase& patch_case, std::ostream* out) {
  *out << patch_case.patch;
}

class MergePatch : public testing::TestWithParam<PatchCase> {};

// Each state is the difference from the defaults.
TEST_P(MergePatch, FollowsRfc7386) {
  Settings settings;
  ASSERT_TRUE(apply_patch(settings, json::parse(GetParam().before)));
  const Result<json> applied = apply_patch(settings, json::parse(GetParam().patch));
  ASSERT_TRUE(applied) << applied.error().message;
  EXPECT_EQ(*applied, json::parse(GetParam().applied));
  EXPECT_EQ(difference(Settings{}, settings), json::parse(GetParam().after));
}

INSTANTIATE_TEST_SUITE_P(
    Cases, MergePatch,
    testing::Values(
        // Members replace.
        PatchCase{R"({"tone_map":{"curve":"aces"}})", R"({"tone_map":{"curve":"agx"}})",
                  R"({"tone_map":{"curve":"agx"}})", R"({"tone_map":{"curve":"agx"}})"},
        // Absent members stay.
        PatchCase{R"({"tone_map":{"curve":"aces"}})", R"({"sampling":{"seed":5}})",
                  R"({"sampling":{"seed":5}})",
                  R"({"tone_map":{"curve":"aces"},"sampling":{"seed":5}})"},
        PatchCase{R"({"shadows":{"enabled":false}})",
                  R"({"shadows":{"angular_diameter_override":2}})",
                  R"({"shadows":{"angular_diameter_override":2.0}})",
                  R"({"shadows":{"enabled":false,"angular_diameter_override":2.0}})"},
        // Null resets a setting ...
        PatchCase{R"({"shadows":{"enabled":false,"angular_diameter_override":2}})",
                  R"({"shadows":{"enabled":null}})", R"({"shadows":{"enabled":true}})",
                  R"({"shadows":{"angular_diameter_override":2.0}})"},
        // ... or a whole group, even one with default values.
        PatchCase{R"({"shadows":{"enabled":false,"angular_diameter_override":2}})",
                  R"({"shadows":null})",
                  R"({"shadows":{"enabled":true,"angular_diameter_override":-1.0}})", "{}"},
        PatchCase{"{}", R"({"tone_map":null})", R"({"tone_map":{"curve":"neutral"}})", "{}"},
        // Empty patches do nothing.
        PatchCase{R"({"sampling":{"seed":5}})", "{}", "{}", R"({"sampling":{"seed":5}})"},
        PatchCase{R"({"sampling":{"seed":5}})", R"({"sampling":{}})", "{}",
                  R"({"sampling":{"seed":5}})"},
        // JavaScript does not distinguish 5.0 from 5.
        PatchCase{"{}", R"({"sampling":{"seed":5.0},"exposure":{"compensation":1}})",
                  R"({"sampling":{"seed":5},"exposure":{"compensation":1.0}})",
                  R"({"sampling":{"seed":5},"exposure":{"compensation":1.0}})"}));

struct BadPatch {
  const char* patch;
  const char* path;
  const char* reason_part;
  const char* limit;
};

void PrintTo(const BadPatch& bad, std::ostream* out) {
  *out << bad.patch;
}

class PatchRefuses : public testing::TestWithParam<BadPatch> {};

TEST_P(PatchRefuses, NamesPathReasonAndLimitAndChangesNothing) {
  Settings settings = everything_changed();
  const Result<json> applied = apply_patch(settings, json::parse(GetParam().patch));
  ASSERT_FALSE(applied);
  EXPECT_EQ(applied.error().code, ErrorCode::invalid_params);
  EXPECT_EQ(applied.error().path, GetParam().path);
  EXPECT_NE(applied.error().reason.find(GetParam().reason_part), std::string::npos)
      << applied.error().reason;
  EXPECT_EQ(applied.error().limit, GetParam().limit);
  EXPECT_EQ(settings, everything_changed());
}

INSTANTIATE_TEST_SUITE_P(
    Cases, PatchRefuses,
    testing::Values(
        BadPatch{"null", "patch", "must be an object", ""},
        BadPatch{"[]", "patch", "must be an object", ""},
        BadPatch{"3", "patch", "must be an object", ""},
        BadPatch{R"({"tone_mapp":{"curve":"agx"}})", "tone_mapp", "did you mean tone_map?", ""},
        BadPatch{R"({"tone_map":{"curv":"agx"}})", "tone_map.curv", "did you mean tone_map.curve?",
                 ""},
        BadPatch{R"({"zzz":null})", "zzz", "unknown setting", ""},
        BadPatch{R"({"":{}})", "", "unknown setting", ""},
        BadPatch{R"({"tone_map":{"":1}})", "tone_map.", "unknown setting", ""},
        BadPatch{R"({"tone_map.curve":"agx"})", "tone_map.curve", "nested objects", ""},
        BadPatch{R"({"tone_map":"agx"})", "tone_map", "is a group", "an object or null"},
        BadPatch{R"({"tone_map":[]})", "tone_map", "is a group", "an object or null"},
        BadPatch{R"({"tone_map":{"curve":{"deeper":1}}})", "tone_map.curve", "must be a string",
                 "neutral, aces, agx or linear"},
        BadPatch{R"({"tone_map":{"curve":1}})", "tone_map.curve", "must be a string",
                 "neutral, aces, agx or linear"},
        BadPatch{R"({"tone_map":{"curve":"AGX"}})", "tone_map.curve", "unknown value",
                 "neutral, aces, agx or linear"},
        BadPatch{R"({"shadows":{"enabled":1}})", "shadows.enabled", "must be true or false", ""},
        BadPatch{R"({"shadows":{"enabled":"true"}})", "shadows.enabled", "must be true or false",
                 ""},
        BadPatch{R"({"exposure":{"compensation":"1"}})", "exposure.compensation",
                 "must be a number", "-16 to 16"},
        BadPatch{R"({"exposure":{"compensation":true}})", "exposure.compensation",
                 "must be a number", "-16 to 16"},
        BadPatch{R"({"exposure":{"compensation":16.001}})", "exposure.compensation", "out of range",
                 "-16 to 16"},
        BadPatch{R"({"exposure":{"compensation":1e300}})", "exposure.compensation", "out of range",
                 "-16 to 16"},
        BadPatch{R"({"sampling":{"seed":0.5}})", "sampling.seed", "integer", "0 to 2147483647"},
        BadPatch{R"({"sampling":{"seed":-1}})", "sampling.seed", "out of range", "0 to 2147483647"},
        BadPatch{R"({"sampling":{"seed":18446744073709551615}})", "sampling.seed", "out of range",
                 "0 to 2147483647"},
        BadPatch{R"({"view":{"buffer":""}})", "view.buffer", "not a valid name",
                 "1 to 64 characters of A-Z a-z 0-9 _ . -"},
        // Atomic: a valid member next to an invalid one is not applied.
        BadPatch{R"({"exposure":{"compensation":1},"sampling":{"seed":-1}})", "sampling.seed",
                 "out of range", "0 to 2147483647"},
        BadPatch{R"({"exposure":{"compensation":1},"zzz":1})", "zzz", "unknown setting", ""}));

TEST(PatchRefuses, NumbersThatAreNotFinite) {
  for (const double value : {std::nan(""), std::numeric_limits<double>::infinity(),
                             -std::numeric_limits<double>::infinity()}) {
    Settings settings;
    const Result<json> applied =
        apply_patch(settings, json{{"exposure", {{"compensation", value}}}});
    ASSERT_FALSE(applied);
    EXPECT_NE(applied.error().reason.find("finite"), std::string::npos);
    EXPECT_EQ(settings, Settings{});
  }
}

TEST(PatchRefuses, AViewBufferOfTooManyCharacters) {
  Settings settings;
  EXPECT_TRUE(apply_patch(settings, json{{"view", {{"buffer", std::string(64, 'a')}}}}));
  EXPECT_FALSE(apply_patch(settings, json{{"view", {{"buffer", std::string(65, 'a')}}}}));
}

TEST(SettingsSchema, DescribesEveryLeaf) {
  const json schema = settings_schema();
  EXPECT_EQ(schema.at("$schema"), "https://json-schema.org/draft/2020-12/schema");
  std::size_t order = 0;
  for (const SettingDescriptor& setting : setting_descriptors()) {
    const json& group = schema.at("properties").at(std::string(setting.group));
    EXPECT_EQ(group.at("type"), "object");
    EXPECT_EQ(group.at("additionalProperties"), false);
    EXPECT_TRUE(group.at("title").is_string());
    const json& leaf = group.at("properties").at(std::string(setting.name));
    EXPECT_EQ(leaf.at("description"), setting.help);
    EXPECT_EQ(leaf.at("x-order"), order++);
    EXPECT_EQ(leaf.contains("x-unit"), !setting.unit.empty());
    EXPECT_EQ(leaf.at("x-resets"), scope_names(setting.resets));
    EXPECT_EQ(leaf.at("default"),
              to_json(Settings{}).at(std::string(setting.group)).at(std::string(setting.name)));
  }
}

TEST(SettingsSchema, HasTypesAndLimits) {
  const json groups = settings_schema().at("properties");
  const json curve = groups["tone_map"]["properties"]["curve"];
  EXPECT_EQ(curve["type"], "string");
  EXPECT_EQ(curve["enum"], json::parse(R"(["neutral","aces","agx","linear"])"));
  const json samples = groups["accumulation"]["properties"]["max_samples"];
  EXPECT_EQ(samples["type"], "integer");
  EXPECT_TRUE(samples["minimum"].is_number_integer());
  EXPECT_EQ(samples["maximum"], 65536);
  const json radius = groups["ambient"]["properties"]["radius"];
  EXPECT_EQ(radius["type"], "number");
  EXPECT_EQ(radius["minimum"], 0.05);
  EXPECT_EQ(radius["x-unit"], "metres");
  EXPECT_EQ(groups["environment"]["x-order"], 0);
  EXPECT_EQ(groups["gbuffer"]["x-order"], 1);
  EXPECT_EQ(groups["shadows"]["x-order"], 2);
}

}  // namespace
}  // namespace heliograph::protocol
