#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "render/frame/frame.hpp"
#include "tests/gpu/denoise/atrous_field.hpp"

// Passes that blur visibility and reflections together, against a blur of each alone.

namespace heliograph::test {
namespace {

constexpr auto by_halves = protocol::BlurKernel::separable;

std::set<std::string> names_of_passes_that_ran(FrameRig& rig) {
  std::set<std::string> names;
  for (const auto& timing : rig.plan().timings()) {
    if (timing.milliseconds >= 0.0f) names.insert(timing.name);
  }
  return names;
}

/// Of the same surfaces, whose roughness grows from column to column: the first are not blurred, or
/// once, where levels follow roughness.
struct TwoSignals {
  FilterInput visibility{7}, reflection{8};

  TwoSignals() {
    for (std::size_t i = 0; i < field_pixels; ++i) {
      const auto x = static_cast<float>(i % field_width);
      const float roughness = stored_roughness(x < 8.0f ? 0.0f : x < 16.0f ? 0.04f : 0.025f * x);
      glm::vec4& guide = visibility.guide[i];
      guide = glm::vec4(glm::normalize(glm::vec3(guide)) * (1.0f + roughness), guide.w);
    }
    reflection.guide = visibility.guide;
    reflection.slope = visibility.slope;
  }
};

struct PairRig {
  PairRig(const TwoSignals& in, const shared::AtrousConstants& of_visibility,
          const shared::AtrousConstants& of_reflection, int iterations)
      : rig(SceneBuilder().build(), look({0, 0, 3}, {0, 0, 0}), {.extent = field_extent}) {
    constexpr VkFormat four = render::formats::four_floats;
    const FilterInput& surfaces = in.visibility;
    render::AtrousInput input{rig.input("guide", four, surfaces.guide),
                              rig.input("slope", VK_FORMAT_R32G32_SFLOAT, surfaces.slope),
                              rig.input("visibility", four, in.visibility.signal),
                              packed_input(rig, surfaces.guide, surfaces.slope)};
    rig.plan().use_host_kernels(false);
    const render::SignalBlur visibility{
        input, filter_config(rig, of_visibility, false, iterations, by_halves)};
    input.signal = rig.input("reflection", four, in.reflection.signal);
    const render::SignalBlur reflection{
        input, filter_config(rig, of_reflection, true, iterations, by_halves)};
    filtered = render::blur_together(rig.plan(), rig.inputs(), visibility, reflection,
                                     [this] { return traces_visibility; });
  }

  FrameRig rig;
  render::BlurredPair filtered;
  bool traces_visibility = true;
};

/// `changed`: mean change by the filter.
void expect_same(const render::FloatImage& got, const render::FloatImage& alone,
                 const FilterInput& input, const std::string& which) {
  ASSERT_EQ(got.rgba.size(), alone.rgba.size());
  const double values = static_cast<double>(got.rgba.size());
  double mean_off = 0.0, changed = 0.0;
  for (std::size_t i = 0; i < got.rgba.size(); ++i) {
    const double off = std::abs(static_cast<double>(got.rgba[i]) - alone.rgba[i]);
    // Signals of 0 to 1 are off by a few steps of half floats.
    ASSERT_LT(off, 2e-3) << which << ", texel " << i / 4 << " channel " << i % 4;
    mean_off += off / values;
    const std::size_t texel = i / 4 / got.width * field_width + i / 4 % got.width;
    changed += std::abs(got.rgba[i] - input.signal[texel][static_cast<int>(i % 4)]) / values;
  }
  EXPECT_LT(mean_off, 1e-4) << which;
  EXPECT_GT(changed, 0.01) << "the filter changes nothing: " << which;
}

TEST(AtrousPair, BlursEachSignalAsAlone) {
  const TwoSignals in;
  for (const std::uint32_t flags :
       {0u, shared::atrous_variance_prefilter | shared::atrous_jitter}) {
    for (const std::uint32_t of_levels :
         {0u, shared::atrous_levels_by_roughness, shared::atrous_lobe_limit}) {
      for (const auto& [level, iterations] : {std::pair(0, 1), {0, 3}, {2, 2}}) {
        for (const float threshold : {2.0f, 0.5f}) {
          shared::AtrousConstants of_visibility = plain_constants();
          of_visibility.level = level;
          of_visibility.flags = flags;
          of_visibility.start_threshold = threshold;
          shared::AtrousConstants of_reflection = of_visibility;
          of_reflection.luminance_sigma = 1.5f;
          of_reflection.flags = flags | of_levels | shared::atrous_keep_variance;
          const std::string which = "flags " + std::to_string(of_reflection.flags) + ", " +
                                    std::to_string(iterations) + " iterations from level " +
                                    std::to_string(level) + ", threshold " +
                                    std::to_string(threshold);
          PairRig pair(in, of_visibility, of_reflection, iterations);
          pair.rig.run();
          EXPECT_TRUE(
              names_of_passes_that_ran(pair.rig).contains("visibility_specular.atrous.0.first"));
          FilterRig visibility(in.visibility, of_visibility, false, iterations, by_halves);
          FilterRig reflection(in.reflection, of_reflection, true, iterations, by_halves);
          expect_same(pair.rig.read(pair.filtered.visibility), visibility.run(), in.visibility,
                      "visibility, " + which);
          expect_same(pair.rig.read(pair.filtered.specular), reflection.run(), in.reflection,
                      "reflections, " + which);
        }
      }
    }
  }
}

/// `see`: sets how a rig is seen or drawn.
void expect_each_as_alone(const std::function<void(FrameRig&)>& see, const std::string& which) {
  const TwoSignals in;
  shared::AtrousConstants of_reflection = plain_constants();
  of_reflection.flags |= shared::atrous_levels_by_roughness;
  PairRig pair(in, plain_constants(), of_reflection, 3);
  FilterRig visibility(in.visibility, plain_constants(), false, 3, by_halves);
  FilterRig reflection(in.reflection, of_reflection, true, 3, by_halves);
  for (FrameRig* const rig : {&pair.rig, &visibility.rig, &reflection.rig}) see(*rig);
  pair.rig.run();
  expect_same(pair.rig.read(pair.filtered.visibility), visibility.run(), in.visibility,
              "visibility, " + which);
  expect_same(pair.rig.read(pair.filtered.specular), reflection.run(), in.reflection,
              "reflections, " + which);
}

TEST(AtrousPair, BlursEachSignalAsAloneInOrthographicViews) {
  scene::Camera camera = look({0, 0, 3}, {0, 0, 0});
  camera.orthographic_height = 4.0f;
  expect_each_as_alone([&](FrameRig& rig) { rig.set_view(camera); }, "orthographic");
}

TEST(AtrousPair, BlursEachSignalAsAloneInReducedFrames) {
  const scene::Camera camera = look({0, 0, 3}, {0, 0, 0});
  for (const VkExtent2D drawn : {VkExtent2D{25, 16}, {17, 23}, {21, 3}}) {
    expect_each_as_alone(
        [&](FrameRig& rig) { rig.draw_smaller(drawn, camera); },
        std::to_string(drawn.width) + " by " + std::to_string(drawn.height) + " pixels");
  }
}

TEST(AtrousPair, LeavesReflectionsWhereVisibilityIsBlurred) {
  const TwoSignals in;
  shared::AtrousConstants of_reflection = plain_constants();
  of_reflection.flags |= shared::atrous_levels_by_roughness;
  PairRig pair(in, plain_constants(), of_reflection, 1);
  pair.rig.run();
  const render::FloatImage visibility = pair.rig.read(pair.filtered.visibility);
  const render::FloatImage reflection = pair.rig.read(pair.filtered.specular);
  float change = 0.0f;
  for (std::size_t i = 0; i < field_pixels; ++i) {
    if (i % field_width >= 8) continue;  // smooth
    // Between the passes both hold 16 bits.
    ASSERT_NEAR(reflection.rgba[4 * i], in.reflection.signal[i].x, 3e-4f) << i;
    change += std::abs(visibility.rgba[4 * i] - in.visibility.signal[i].x);
  }
  EXPECT_GT(change, 0.05f * 8 * field_height);
}

// Depth, normals, steps, jitter and the variance filter are settings of each signal.
TEST(AtrousPair, IsForFramesWithTheSameTaps) {
  const TwoSignals in;
  const auto change = [](auto edit) {
    shared::AtrousConstants made = plain_constants();
    edit(made);
    return made;
  };
  for (const shared::AtrousConstants& of_reflection :
       {change([](auto& c) { c.depth_sigma = 4.0f; }),
        change([](auto& c) { c.normal_power = 8.0f; }),
        change([](auto& c) { c.start_threshold = -1.0f; }),
        change([](auto& c) { c.flags ^= shared::atrous_variance_prefilter; }),
        change([](auto& c) { c.flags ^= shared::atrous_jitter; })}) {
    PairRig pair(in, plain_constants(), of_reflection, 2);
    pair.rig.run();
    EXPECT_FALSE(names_of_passes_that_ran(pair.rig).contains("visibility_specular.atrous.0.first"));
    FilterRig visibility(in.visibility, plain_constants(), false, 2, by_halves);
    FilterRig reflection(in.reflection, of_reflection, true, 2, by_halves);
    expect_same(pair.rig.read(pair.filtered.visibility), visibility.run(), in.visibility,
                "visibility");
    expect_same(pair.rig.read(pair.filtered.specular), reflection.run(), in.reflection,
                "reflections");
  }
}

TEST(AtrousPair, BlursReflectionsWhereNoVisibilityIsTraced) {
  const TwoSignals in;
  PairRig pair(in, plain_constants(), plain_constants(), 2);
  for (const bool traced : {true, false, true}) {
    pair.traces_visibility = traced;
    pair.rig.run();
    const auto ran = names_of_passes_that_ran(pair.rig);
    EXPECT_EQ(ran.contains("visibility_specular.atrous.1.second"), traced);
    EXPECT_EQ(ran.contains("specular.atrous.1.second"), !traced);
    EXPECT_FALSE(ran.contains("visibility.atrous.1.second"));
    FilterRig reflection(in.reflection, plain_constants(), true, 2, by_halves);
    expect_same(pair.rig.read(pair.filtered.specular), reflection.run(), in.reflection,
                "reflections");
  }
}

class AtrousPairFrame : public testing::Test {
 protected:
  static std::set<std::string> passes_of_frame(const protocol::Settings& settings) {
    SceneBuilder scene;
    scene.place(scene.add_sphere(1.0f, surface({0.8f, 0.2f, 0.1f}, 0.4f)));
    scene.add_sun({0.3f, -0.5f, -1.0f}, {3, 2, 1});
    FrameRig rig(scene.build(), look({0, 0.2f, 3}, {0, 0, 0}),
                 {.extent = {48, 32}, .settings = settings});
    const auto outputs = render::declare_frame(rig.plan(), rig.inputs());
    rig.plan().read_back(outputs.output);
    rig.run();
    return names_of_passes_that_ran(rig);
  }
};

TEST_F(AtrousPairFrame, FollowsDeviceAndSettings) {
  const char* const together = "visibility_specular.atrous.0.first";
  protocol::Settings settings = without_indirect();
  {
    FrameRig rig(SceneBuilder().build(), look({0, 0, 3}, {0, 0, 0}));
    if (rig.plan().device().is_cpu()) {
      EXPECT_FALSE(passes_of_frame(settings).contains(together));
      GTEST_SKIP() << "processors blur each signal alone";
    }
  }
  const auto by_default = passes_of_frame(settings);
  EXPECT_TRUE(by_default.contains(together));
  EXPECT_FALSE(by_default.contains("visibility.atrous.0.first"));
  EXPECT_FALSE(by_default.contains("specular.atrous.0.first"));

  settings.specular_blur.adapt_start = true;
  const auto apart = passes_of_frame(settings);
  EXPECT_FALSE(apart.contains(together));
  EXPECT_TRUE(apart.contains("visibility.atrous.0.first"));
  EXPECT_TRUE(apart.contains("specular.atrous.0.first"));

  settings = without_indirect();
  settings.shadows.enabled = settings.ambient.occlusion = false;
  const auto without_visibility = passes_of_frame(settings);
  EXPECT_FALSE(without_visibility.contains(together));
  EXPECT_FALSE(without_visibility.contains("visibility.atrous.0.first"));
  EXPECT_TRUE(without_visibility.contains("specular.atrous.0.first"));

  for (const char* assignment :
       {"shadow_blur.iterations=4", "shadow_blur.kernel=full", "specular_blur.feedback=0",
        "shadow_blur.half_resolution=true", "specular_blur.enabled=false"}) {
    settings = without_indirect();
    ASSERT_TRUE(protocol::set_by_path(settings, assignment)) << assignment;
    EXPECT_FALSE(passes_of_frame(settings).contains(together)) << assignment;
  }
}

}  // namespace
}  // namespace heliograph::test
