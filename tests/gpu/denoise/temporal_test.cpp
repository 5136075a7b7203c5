#include "render/passes/denoise/temporal.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>

#include "render/resources/moving/scene_motion.hpp"
#include "tests/gpu/denoise/post_and_wall.hpp"
#include "tests/gpu/support/kernel_comparison.hpp"

namespace heliograph::test {
namespace {

constexpr std::uint32_t width = wall_extent.width, height = wall_extent.height;
constexpr std::uint32_t pixels = width * height;

/// Of histories of visibility.
constexpr float fraction_step = 1.0f / 65535.0f;

/// A wall that fills the frame; the test supplies the signal of every frame.
class TemporalAccumulation : public testing::Test {
 protected:
  void start(const protocol::Settings& settings, bool specular = false, bool host = false) {
    protocol::Settings plain = settings;
    plain.antialiasing.jitter = false;
    scene_.emplace(1.0f);
    rig_.emplace(scene_->builder.build(), scene_->from(5.0f),
                 RigOptions{.extent = wall_extent, .settings = plain});
    const render::GBuffer gbuffer = render::rasterize_gbuffer(rig_->plan(), rig_->inputs());
    const render::Guide guide = render::reproject(rig_->plan(), rig_->inputs(), gbuffer);
    raw_ = rig_->input("raw", VK_FORMAT_R32G32B32A32_SFLOAT, std::vector(pixels, glm::vec4(0.0f)));
    auto& plan = rig_->plan();
    plan.use_host_kernels(host);
    const auto histories = render::declare_sample_histories(plan, {});
    accumulated_ =
        specular
            ? render::accumulate_radiance(plan, rig_->inputs(), gbuffer, guide,
                                          render::specular_channel(rig_->inputs(), histories), raw_)
            : render::accumulate_visibility(plan, rig_->inputs(), guide, histories, raw_);
  }
  /// One frame of a static view with signal `values`.
  void frame(const std::vector<glm::vec4>& values) {
    if (drawn_) rig_->set_view(scene_->from(5.0f), ++frames_);
    drawn_ = true;
    rig_->fill(raw_, values);
    rig_->run();
  }
  void frame(const glm::vec4& value) { frame(std::vector(pixels, value)); }
  glm::vec4 signal() { return texel(rig_->read(accumulated_.signal), 20, 16); }
  glm::vec4 history_length() { return texel(rig_->read(accumulated_.history_length), 20, 16); }

  static protocol::Settings plain_settings() {
    protocol::Settings settings;
    for_both(settings, [](auto& s) {
      s.history_seconds = 0.0f;
      s.history_frames = 32;
      s.rectification = protocol::Rectification::off;
    });
    return settings;
  }
  template <class Change>
  static void for_both(protocol::Settings& settings, Change change) {
    change(settings.shadow_temporal);
    change(settings.specular_temporal);
  }

  std::optional<PostAndWall> scene_;
  std::optional<FrameRig> rig_;
  gpu::ImageRef raw_;
  render::AccumulatedSignal accumulated_;
  bool drawn_ = false;
  std::uint32_t frames_ = 0;
};

TEST_F(TemporalAccumulation, IsMeanWhileHistoryGrows) {
  start(plain_settings());
  double sum = 0.0;
  for (int i = 1; i <= 20; ++i) {
    const float value = i % 3 == 0 ? 1.0f : 0.25f;
    sum += value;
    frame(glm::vec4(value, 1.0f - value, 0, 0));
    EXPECT_NEAR(signal().x, sum / i, 3 * fraction_step) << i;
    EXPECT_NEAR(signal().y, 1.0 - sum / i, 3 * fraction_step) << i;
    EXPECT_NEAR(history_length().x, i, 1e-3);
  }
}

TEST_F(TemporalAccumulation, HistoryCountsOnlySamples) {
  for (const bool specular : {false, true}) {
    drawn_ = false;
    start(plain_settings(), specular);
    double sum = 0.0;
    int samples = 0;
    for (int i = 0; i < 24; ++i) {
      const float value = i % 2 == 0 ? 1.0f : 0.25f;
      const bool sampled = i < 4 || i % 5 == 0;
      if (sampled) {
        sum += value;
        ++samples;
        frame(specular ? glm::vec4(glm::vec3(value), 2.0f) : glm::vec4(value, value, 0, 0));
      } else {
        frame(specular ? glm::vec4(0, 0, 0, -2.0f) : glm::vec4(-1, -1, 0, 0));
      }
      const double exact_to = specular ? 1e-3 : 3 * fraction_step;
      EXPECT_NEAR(signal().x, sum / samples, exact_to) << i;
      EXPECT_NEAR(signal().y, sum / samples, exact_to) << i;
      EXPECT_NEAR(history_length().x, samples, 1e-3) << i;
    }
  }
}

TEST_F(TemporalAccumulation, VarianceStaysWithoutSamples) {
  start(plain_settings());
  for (int i = 0; i < 12; ++i) frame(glm::vec4(i % 2, 1.0f, 0, 0));
  const glm::vec4 before = signal();
  EXPECT_GT(before.z, 0.01f);
  for (int i = 0; i < 8; ++i) frame(glm::vec4(-1, -1, 0, 0));
  EXPECT_NEAR(signal().z, before.z, 0.2f * fraction_step);
  EXPECT_NEAR(signal().w, before.w, 0.2f * fraction_step);
}

TEST_F(TemporalAccumulation, HistoryLengthIsInSecondsNotFrames) {
  for (const float rate : {20.0f, 200.0f}) {
    drawn_ = false;
    protocol::Settings settings = plain_settings();
    settings.shadow_temporal.history_seconds = 0.5f;
    settings.shadow_temporal.history_frames = 1;
    start(settings);
    rig_->set_seconds(1.0f / rate);
    const int half_a_second = static_cast<int>(0.5f * rate);
    for (int i = 0; i < 2 * half_a_second; ++i) frame(glm::vec4(0.0f));
    EXPECT_NEAR(history_length().x, half_a_second, 0.1);
    for (int i = 0; i < half_a_second; ++i) frame(glm::vec4(1.0f));
    EXPECT_NEAR(signal().x, 1.0 - std::exp(-1.0), 0.03) << "same elapsed time at any frame rate";
  }
}

TEST_F(TemporalAccumulation, MovingLightsShortenShadowHistoryNotAmbient) {
  start(plain_settings());
  for (int i = 0; i < 40; ++i) frame(glm::vec4(1.0f));
  rig_->set_scene_motion({.lights = 0.1f});
  for (int i = 0; i < 4; ++i) frame(glm::vec4(0.0f));
  const double frames = render::frames_under_motion(0.1f);
  EXPECT_NEAR(history_length().x, frames, 1e-3);
  EXPECT_NEAR(signal().x, std::pow(1.0 - 1.0 / frames, 4), 1e-3);
  EXPECT_NEAR(signal().y, std::pow(31.0 / 32.0, 4), 1e-3);
}

TEST_F(TemporalAccumulation, MovingLightsShortenSpecularHistoryLess) {
  start(plain_settings(), true);
  for (int i = 0; i < 40; ++i) frame(glm::vec4(1.0f));
  rig_->set_scene_motion({.lights = 0.1f});
  frame(glm::vec4(0.0f));
  const float frames = 4.0f * render::frames_under_motion(0.1f);
  EXPECT_NEAR(history_length().x, frames, frames / 1024.0f);
}

TEST_F(TemporalAccumulation, RotatingEnvironmentShortensSpecularHistory) {
  start(plain_settings(), true);
  for (int i = 0; i < 40; ++i) frame(glm::vec4(1.0f));
  rig_->set_scene_motion({.environment = glm::radians(10.0f)});
  frame(glm::vec4(0.0f));
  const float lobe = 4.0f * std::atan(1.0f);  // the wall is rough
  EXPECT_NEAR(history_length().x, render::frames_under_motion(glm::radians(10.0f) / lobe), 1e-2);
}

TEST_F(TemporalAccumulation, HistoryLengthIsUnlimitedForStaticView) {
  start(plain_settings());
  for (std::uint32_t i = 0; i < 60; ++i) {
    rig_->set_accumulated(i);
    frame(glm::vec4(static_cast<float>(i % 2)));
  }
  EXPECT_NEAR(history_length().x, 60.0f, 0.01f);
  EXPECT_NEAR(signal().x, 0.5f, 1e-4f);
}

TEST_F(TemporalAccumulation, HdrStepConvergesWithoutStuckMoments) {
  protocol::Settings settings = plain_settings();
  settings.specular_temporal.history_frames = 100;
  settings.specular_temporal.mean_variance = false;
  start(settings, true);
  for (int i = 0; i < 120; ++i) frame(glm::vec4(5000, 5000, 5000, 1));
  EXPECT_NEAR(signal().x, 5000.0f, 1.0f);
  EXPECT_NEAR(history_length().z, 5000.0f, 1.0f);
  EXPECT_NEAR(history_length().w, 0.0f, 1.0f) << "its square exceeds the range of half floats";
  for (int i = 0; i < 1200; ++i) frame(glm::vec4(0.01f, 0.01f, 0.01f, 1));
  EXPECT_NEAR(signal().x, 0.01f + 5000.0 * std::pow(0.99, 1200), 0.02f);
  EXPECT_NEAR(history_length().z, 0.01f, 1e-4f);
  EXPECT_NEAR(history_length().w, 0.0f, 1e-2f);
}

TEST_F(TemporalAccumulation, LongHistoryFollowsSmallChanges) {
  for (const bool host : {false, true}) {
    if (host && !has_host_kernels()) continue;
    for (const bool specular : {false, true}) {
      drawn_ = false;
      start(plain_settings(), specular, host);
      // A new sample's part is less than half of a step, of half floats and of fractions.
      const float from = 1.0f, to = specular ? 0.9f : 0.995f;
      for (std::uint32_t i = 0; i < 1500; ++i) {
        rig_->set_accumulated(i);
        frame(glm::vec4(i < 1000 ? from : to));
      }
      const render::FloatImage image = rig_->read(accumulated_.signal);
      double sum = 0.0;
      for (std::size_t i = 0; i < pixels; ++i) sum += image.rgba[4 * i];
      const double expected = (1000.0 * from + 500.0 * to) / 1500.0;
      EXPECT_NEAR(sum / pixels, expected, 0.03 * (from - to)) << host << specular;
      EXPECT_NEAR(signal().x, expected, 0.1 * (from - to)) << host << specular;
    }
  }
}

TEST_F(TemporalAccumulation, NaNsAndInfinitiesBecomeBlack) {
  start(plain_settings(), true);
  frame(glm::vec4(1.0f));
  std::vector<glm::vec4> bad(pixels, glm::vec4(1.0f));
  bad[16 * width + 20] = glm::vec4(std::numeric_limits<float>::quiet_NaN());
  bad[16 * width + 21] = glm::vec4(std::numeric_limits<float>::infinity());
  frame(bad);
  for (int i = 0; i < 3; ++i) frame(glm::vec4(1.0f));
  const render::FloatImage got = rig_->read(accumulated_.signal);
  for (const float value : got.rgba) EXPECT_TRUE(std::isfinite(value));
  EXPECT_NEAR(signal().x, 0.8f, 1e-5f) << "counts as one black sample";
}

TEST_F(TemporalAccumulation, RestartsWhereHistoryIsInvalid) {
  start(plain_settings());
  for (int i = 0; i < 5; ++i) frame(glm::vec4(1.0f));
  FrameRig fresh(scene_->builder.build(), scene_->from(5.0f), {.extent = wall_extent});
  EXPECT_EQ(fresh.constants().history_invalid, 1u) << "history is invalid in the first frame";
  EXPECT_EQ(rig_->constants().history_invalid, 0u);
  protocol::Settings off = plain_settings();
  off.shadow_temporal.enabled = false;
  rig_->set_settings(off);
  frame(glm::vec4(0.25f));
  EXPECT_EQ(signal().x, 0.25f);
  EXPECT_EQ(history_length().x, 1.0f);
}

class Rectification : public TemporalAccumulation,
                      public testing::WithParamInterface<protocol::Rectification> {};
INSTANTIATE_TEST_SUITE_P(
    Modes, Rectification,
    testing::Values(protocol::Rectification::color_clamp, protocol::Rectification::color_clip,
                    protocol::Rectification::variance_clamp, protocol::Rectification::variance_clip,
                    protocol::Rectification::fast_history, protocol::Rectification::percentile,
                    protocol::Rectification::gradient),
    [](const auto& instance) { return std::string(protocol::enum_name(instance.param)); });

TEST_P(Rectification, SwitchedOffLightFadesFaster) {
  for (const bool specular : {false, true}) {
    drawn_ = false;
    protocol::Settings settings = plain_settings();
    for_both(settings, [](auto& s) { s.rectification = GetParam(); });
    start(settings, specular);
    for (int i = 0; i < 40; ++i) frame(glm::vec4(1.0f));
    rig_->set_scene_motion({.geometry_moved = true});
    for (int i = 0; i < 8; ++i) frame(glm::vec4(0.0f));
    EXPECT_LT(signal().x, 0.3f) << specular;  // without: (31/32)^8 = 0.78
  }
}

TEST_P(Rectification, UniformSignalIsUnchanged) {
  for (const bool specular : {false, true}) {
    drawn_ = false;
    protocol::Settings settings = plain_settings();
    for_both(settings, [](auto& s) { s.rectification = GetParam(); });
    start(settings, specular);
    for (int i = 0; i < 12; ++i) frame(glm::vec4(0.5f));
    EXPECT_NEAR(signal().x, 0.5f, 1e-3f) << specular;
    EXPECT_NEAR(history_length().x, 12.0f, 0.1f) << specular;
  }
}

}  // namespace
}  // namespace heliograph::test
