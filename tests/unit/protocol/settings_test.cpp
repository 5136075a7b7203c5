#include "protocol/settings/settings.hpp"

#include <gtest/gtest.h>

#include <set>
#include <type_traits>

namespace heliograph::protocol {
namespace {

static_assert(std::is_enum_v<ToneMapCurve> && !std::is_convertible_v<ToneMapCurve, int>);

TEST(Settings, PathsAreUniqueAndConsistOfGroupAndName) {
  std::set<std::string_view> paths;
  for (const SettingDescriptor& setting : setting_descriptors()) {
    EXPECT_TRUE(paths.insert(setting.path).second) << setting.path << " stands twice";
    EXPECT_EQ(setting.path, std::string(setting.group) + "." + std::string(setting.name));
    EXPECT_EQ(find_setting(setting.path), &setting);
  }
  EXPECT_EQ(find_setting("tone_map"), nullptr);
  EXPECT_EQ(find_setting(""), nullptr);
}

TEST(Settings, GroupsAndSettingsHaveTheSameOrder) {
  std::vector<std::string_view> in_use;
  for (const SettingDescriptor& setting : setting_descriptors()) {
    if (in_use.empty() || in_use.back() != setting.group) in_use.push_back(setting.group);
  }
  std::vector<std::string_view> declared;
  for (const SettingGroup& group : setting_groups()) declared.push_back(group.path);
  EXPECT_EQ(in_use, declared);
}

TEST(Settings, VisitPassesTheMemberOfTheDescriptor) {
  Settings settings;
  settings.tone_map.curve = ToneMapCurve::agx;
  settings.sampling.seed = 17;
  settings.view.buffer = "normal";
  std::size_t visited = 0;
  visit_settings(settings, [&](const SettingDescriptor& setting, auto& value) {
    EXPECT_EQ(&setting, &setting_descriptors()[visited++]);
    using Value = std::remove_reference_t<decltype(value)>;
    if constexpr (std::is_same_v<Value, ToneMapCurve>) {
      EXPECT_EQ(setting.path, "tone_map.curve");
      EXPECT_EQ(value, ToneMapCurve::agx);
    }
    if constexpr (std::is_same_v<Value, std::string>) {
      EXPECT_EQ(setting.path, "view.buffer");
      EXPECT_EQ(value, "normal");
    }
    if constexpr (std::is_same_v<Value, int>) {
      EXPECT_EQ(value == 17, setting.path == "sampling.seed");
    }
  });
  EXPECT_EQ(visited, setting_descriptors().size());
}

TEST(Settings, DescriptorsHaveTheDefaultsOfTheStruct) {
  const Settings settings;
  visit_settings(settings, [&](const SettingDescriptor& setting, const auto& value) {
    using Value = std::remove_cvref_t<decltype(value)>;
    if constexpr (std::is_enum_v<Value>) {
      EXPECT_EQ(std::get<std::string>(setting.initial), enum_name(value));
      EXPECT_EQ(setting.type, SettingType::choice);
    } else if constexpr (std::is_same_v<Value, Color>) {
      EXPECT_EQ(std::get<std::string>(setting.initial), color_text(value));
      EXPECT_EQ(setting.type, SettingType::color);
    } else {
      EXPECT_EQ(std::get<Value>(setting.initial), value) << setting.path;
    }
  });
}

TEST(Settings, DefaultsAreWithinTheirLimitsAndDescribed) {
  for (const SettingDescriptor& setting : setting_descriptors()) {
    double value = setting.limits.minimum;
    if (const int* whole = std::get_if<int>(&setting.initial)) value = *whole;
    if (const float* number = std::get_if<float>(&setting.initial)) value = *number;
    EXPECT_GE(value, setting.limits.minimum) << setting.path;
    EXPECT_LE(value, setting.limits.maximum) << setting.path;
    const bool numeric =
        setting.type == SettingType::integer || setting.type == SettingType::number;
    EXPECT_EQ(numeric || setting.type == SettingType::text,
              setting.limits.minimum < setting.limits.maximum)
        << setting.path << " lacks a range";
    EXPECT_TRUE(setting.help.ends_with(".")) << setting.path;
    EXPECT_GT(setting.help.size(), 20u) << setting.path;
  }
}

TEST(Settings, OnlyChangesOfTheSampledLightResetTheAccumulation) {
  const Settings before;
  Settings after = before;
  EXPECT_EQ(changed_scope(before, after), ResetScope::none);

  after.exposure.compensation = 1.0f;
  after.tone_map.curve = ToneMapCurve::linear;
  after.accumulation.max_samples = 8;
  EXPECT_EQ(changed_scope(before, after), ResetScope::none);

  after.environment.rotation = 90.0f;
  EXPECT_TRUE(includes(changed_scope(before, after), ResetScope::accumulation));
  EXPECT_EQ(scope_names(changed_scope(before, after)),
            std::vector<std::string_view>{"accumulation"});
}

TEST(SetByPath, ReadsEveryType) {
  Settings settings;
  EXPECT_TRUE(set_by_path(settings, "tone_map.curve=aces"));
  EXPECT_TRUE(set_by_path(settings, "exposure.compensation=-1.5"));
  EXPECT_TRUE(set_by_path(settings, "accumulation.max_samples=256"));
  EXPECT_TRUE(set_by_path(settings, "shadows.enabled=false"));
  EXPECT_TRUE(set_by_path(settings, "view.buffer=gbuffer.normal"));
  EXPECT_TRUE(set_by_path(settings, "background.color=#12aBff"));
  EXPECT_TRUE(set_by_path(settings, "background.upper_color=000001"));
  EXPECT_EQ(settings.tone_map.curve, ToneMapCurve::aces);
  EXPECT_FLOAT_EQ(settings.exposure.compensation, -1.5f);
  EXPECT_EQ(settings.accumulation.max_samples, 256);
  EXPECT_FALSE(settings.shadows.enabled);
  EXPECT_EQ(settings.view.buffer, "gbuffer.normal");
  EXPECT_EQ(settings.background.color, Color{0x12abff});
  EXPECT_EQ(settings.background.upper_color, Color{1});
}

struct Refusal {
  const char* assignment;
  const char* path;
  const char* message_part;
};

void PrintTo(const Refusal& refusal, std::ostream* out) {
  *out << refusal.assignment;
}

class SetByPathRefuses : public testing::TestWithParam<Refusal> {};

TEST_P(SetByPathRefuses, NamesPathAndValidValuesAndChangesNothing) {
  Settings settings;
  const Result<void> result = set_by_path(settings, GetParam().assignment);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::invalid_params);
  EXPECT_EQ(result.error().path, GetParam().path);
  EXPECT_NE(result.error().message.find(GetParam().message_part), std::string::npos)
      << result.error().message;
  EXPECT_EQ(settings, Settings{});
}

INSTANTIATE_TEST_SUITE_P(
    BadAssignments, SetByPathRefuses,
    testing::Values(Refusal{"tone_map.curve", "tone_map.curve", "path=value"},
                    Refusal{"=aces", "=aces", "path=value"}, Refusal{"", "", "path=value"},
                    Refusal{"tone_map.curve=asec", "tone_map.curve", "did you mean aces?"},
                    Refusal{"tone_map.curve=", "tone_map.curve", "neutral, aces, agx or linear"},
                    Refusal{"tonemap.curve=aces", "tonemap.curve", "did you mean tone_map.curve?"},
                    Refusal{"tone_map=aces", "tone_map", "tone_map.curve"},
                    Refusal{"exposure.compensation=17", "exposure.compensation", "-16 to 16"},
                    Refusal{"exposure.compensation=1x", "exposure.compensation",
                            "must be a number"},
                    Refusal{"exposure.compensation=nan", "exposure.compensation", "finite"},
                    Refusal{"exposure.compensation=inf", "exposure.compensation", "finite"},
                    Refusal{"accumulation.max_samples=2.5", "accumulation.max_samples", "integer"},
                    Refusal{"accumulation.max_samples=0", "accumulation.max_samples", "1 to 65536"},
                    Refusal{"sampling.seed=2147483648", "sampling.seed", "0 to 2147483647"},
                    Refusal{"shadows.enabled=maybe", "shadows.enabled", "true or false"},
                    Refusal{"background.color=red", "background.color", "#rrggbb"},
                    Refusal{"background.color=#12345", "background.color", "#rrggbb"},
                    Refusal{"background.color=-12345", "background.color", "#rrggbb"},
                    Refusal{"view.buffer=", "view.buffer", "1 to 64 characters"},
                    Refusal{"view.buffer=a b", "view.buffer", "1 to 64 characters"},
                    Refusal{"view.buffer=\xff", "view.buffer", "1 to 64 characters"}));

TEST(SettingsMarkdown, ListsEverySetting) {
  const std::string page = settings_markdown();
  for (const SettingDescriptor& setting : setting_descriptors()) {
    EXPECT_NE(page.find("`" + std::string(setting.path) + "`"), std::string::npos);
    EXPECT_NE(page.find(std::string(setting.help)), std::string::npos);
  }
}

}  // namespace
}  // namespace heliograph::protocol
