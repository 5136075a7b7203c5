#include "render/passes/denoise/temporal.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <optional>

#include "render/resources/moving/scene_motion.hpp"
#include "tests/gpu/support/kernel_comparison.hpp"

namespace heliograph::test {
namespace {

constexpr std::uint32_t width = 48, height = 32, pixels = width * height;
constexpr VkExtent2D extent{width, height};

/// A post in front of a wall, scaled by `scale`; `joined`: as one instance, whose parts differ in
/// depth only.
struct PostAndWall {
  explicit PostAndWall(float scale_, bool joined = false) : scale(scale_) {
    const auto corners = [&](float x0, float x1, float y, float z) {
      return std::array{scale * glm::vec3(x0, -y, z), scale * glm::vec3(x1, -y, z),
                        scale * glm::vec3(x1, y, z), scale * glm::vec3(x0, y, z)};
    };
    const std::array quads{corners(-20, 20, 15, -4), corners(-0.4f, 0.4f, 5, 0)};
    if (joined) {
      builder.place(builder.add_quads(quads, surface({0.5f, 0.5f, 0.5f})));
      return;
    }
    for (const auto& quad : quads) {
      builder.place(builder.add_quad(quad, surface({0.5f, 0.5f, 0.5f})));
    }
  }
  scene::Camera from(float x) const {
    scene::Camera camera = look(scale * glm::vec3(x, 0.1f, 4), scale * glm::vec3(x, 0.1f, 0));
    camera.near_plane *= scale;
    return camera;
  }

  float scale;
  SceneBuilder builder;
};

/// Renders two frames from two camera positions and reprojects the second into the first.
render::FloatImage reprojected(PostAndWall& scene, float before, float now,
                               protocol::Settings settings = {}) {
  settings.antialiasing.jitter = false;
  FrameRig rig(scene.builder.build(), scene.from(before), {.extent = extent, .settings = settings});
  const render::GBuffer gbuffer = render::rasterize_gbuffer(rig.plan(), rig.inputs());
  const render::Guide guide = render::reproject(rig.plan(), rig.inputs(), gbuffer);
  rig.run();
  rig.set_view(scene.from(now));
  rig.run();
  return rig.read(guide.reprojection);
}

TEST(Reprojection, StaticViewMapsPixelToItself) {
  PostAndWall scene(1.0f);
  const render::FloatImage found = reprojected(scene, 0.3f, 0.3f);
  for (std::uint32_t i = 0; i < pixels; ++i) {
    EXPECT_EQ(found.rgba[4 * i], static_cast<float>(i % width) + 0.5f);
    EXPECT_EQ(found.rgba[4 * i + 1], static_cast<float>(i / width) + 0.5f);
    EXPECT_EQ(found.rgba[4 * i + 2], 1.0f) << "one tap";
    EXPECT_EQ(found.rgba[4 * i + 3], 0.0f);
  }
}

/// Expects disocclusion exactly where the post hid the wall or the texel was outside the frame.
void expect_exact_history(bool joined) {
  PostAndWall scene(1.0f, joined);
  const float before = 0.0f, now = 1.2f;
  const render::FloatImage found = reprojected(scene, before, now);
  const double focal = 0.5 * height / std::tan(glm::radians(22.5));  // pixels
  int hidden = 0;
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      const double slope = (x + 0.5 - 0.5 * width) / focal;
      const bool post = std::abs(now + 4.0 * slope) < 0.4;
      const double position = post ? now + 4.0 * slope : now + 8.0 * slope;  // on post or wall
      const double depth = post ? 4.0 : 8.0;
      const double column = (position - before) / depth * focal + 0.5 * width;
      // From the previous camera the post hides the wall where the view ray crosses the post.
      const double at_post = before + (position - before) * 0.5;
      const double from_edge = std::abs(std::abs(at_post) - 0.4) / 4.0 * focal;
      const bool covered = !post && std::abs(at_post) < 0.4;
      const double from_border = std::min(std::abs(column), std::abs(column - width));
      if ((!post && from_edge < 1.6) || from_border < 1.6) continue;  // 3x3 search
      const bool outside = column < 0.0 || column > width;
      const bool lost = found.rgba[4 * (y * width + x) + 3] == 1.0f;
      EXPECT_EQ(lost, covered || outside) << x << " " << y;
      hidden += covered;
      if (!lost) {
        EXPECT_NEAR(found.rgba[4 * (y * width + x)], column, 0.02) << x;
      }
    }
  }
  EXPECT_GT(hidden, 20) << "too few disoccluded pixels for a test";
}

/// A published denoiser reconstructs the previous position with the current matrix and fails this.
TEST(Reprojection, DisocclusionMatchesAnalyticVisibility) {
  for (const bool joined : {false, true}) {
    SCOPED_TRACE(joined ? "one instance" : "two instances");
    expect_exact_history(joined);
  }
}

/// Whether a pixel's center shows the post; nullopt where it is too close to the edge to decide.
std::optional<bool> shows_post(double x, double eye) {
  const double focal = 0.5 * height / std::tan(glm::radians(22.5));  // pixels
  const double position = eye + 4.0 * (x - 0.5 * width) / focal;
  if (std::abs(std::abs(position) - 0.4) / 4.0 * focal < 0.02) return std::nullopt;
  return std::abs(position) < 0.4;
}

/// Expects that of the four bilinear taps only those on the same surface are used.
void expect_own_taps(bool joined) {
  PostAndWall scene(1.0f, joined);
  const float before = 0.0f, now = 0.17f;
  const render::FloatImage found = reprojected(scene, before, now);
  int shared = 0;
  for (std::uint32_t i = 0; i < pixels; ++i) {
    const float* texel = &found.rgba[4 * i];
    const std::optional<bool> own = shows_post(i % width + 0.5, now);
    if (texel[3] != 0.0f || !own) continue;
    const auto mask = static_cast<unsigned>(texel[2]);
    const double left = std::floor(texel[0] - 0.5);
    const std::optional<bool> sides[2] = {shows_post(left + 0.5, before),
                                          shows_post(left + 1.5, before)};
    for (unsigned tap = 0; tap < 4; ++tap) {
      const std::optional<bool> tap_shows_post = sides[tap & 1];
      if (!(mask >> tap & 1) || !tap_shows_post) continue;
      EXPECT_EQ(*tap_shows_post, *own) << i % width << ", tap " << tap;
    }
    shared += sides[0] && sides[1] && *sides[0] != *sides[1];
  }
  EXPECT_GT(shared, 20) << "too few edge pixels for a test";
}

TEST(Reprojection, RejectsTapsOfOtherSurfaces) {
  for (const bool joined : {false, true}) {
    SCOPED_TRACE(joined ? "one instance" : "two instances");
    expect_own_taps(joined);
  }
}

TEST(Reprojection, IsScaleInvariant) {
  for (const bool joined : {false, true}) {
    PostAndWall one(1.0f, joined), small(0.01f, joined), large(100.0f, joined);
    const render::FloatImage expected = reprojected(one, 0.0f, 0.25f);
    for (PostAndWall* scene : {&small, &large}) {
      const render::FloatImage found = reprojected(*scene, 0.0f, 0.25f);
      int different = 0;
      for (std::uint32_t i = 0; i < pixels; ++i) {
        different += found.rgba[4 * i + 3] != expected.rgba[4 * i + 3];
      }
      EXPECT_LE(different, 2) << scene->scale << (joined ? ", one instance" : ", two instances");
    }
  }
}

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
                 RigOptions{.extent = extent, .settings = plain});
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

TEST(SceneMotion, LightMotionIsRelativeToAngularSizeAndIntensity) {
  SceneBuilder builder;
  builder.add_quad({{{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}}}, surface(glm::vec3(1.0f)));
  builder.place(0).add_sun({0, -1, 0}, glm::vec3(3.0f), 4.0f).add_sun({0, -1, 0}, glm::vec3(1.0f));
  auto scene = std::make_shared<scene::Scene>(*builder.build());
  scene->lights[0].node = 1;
  scene->nodes.push_back({.name = "sun", .transform = scene::Transform{}});
  const glm::quat down = glm::angleAxis(glm::radians(-90.0f), glm::vec3(1, 0, 0));
  const glm::quat end = glm::angleAxis(glm::radians(-100.0f), glm::vec3(1, 0, 0));
  scene::Channel turn{
      .node = 1, .property = scene::Property::rotation, .width = 4, .times = {0, 10}, .values = {}};
  for (const glm::quat& q : {down, end})
    turn.values.insert(turn.values.end(), {q.x, q.y, q.z, q.w});
  scene->clips.push_back({"turn", 10.0f, {turn}});
  FrameRig rig(scene, look({0, 1, 3}, glm::vec3(0.0f)), {.extent = extent});
  const auto motion_at = [&](double seconds) {
    rig.moving().set_pose(&rig.scene().scene->clips[0], seconds);
    rig.moving().advance();
    return render::scene_motion(rig.moving(), rig.constants(), &rig.constants()).lights;
  };
  motion_at(0.0);
  EXPECT_NEAR(motion_at(1.0), 0.75f * 0.25f, 2e-3f) << "one of four degrees, three lights of four";
  EXPECT_EQ(motion_at(1.0), 0.0f) << "static again";
  EXPECT_NEAR(motion_at(9.0), 0.75f, 1e-5f) << "clamped to 1";
  EXPECT_EQ(render::scene_motion(rig.moving(), rig.constants(), nullptr).lights, 0.0f);
}

TEST(FramesUnderMotion, DecreaseFromInfinityToOne) {
  EXPECT_GT(render::frames_under_motion(0.0f), 1e6f);
  EXPECT_NEAR(render::frames_under_motion(0.1f), 3.29f, 0.01f);
  EXPECT_EQ(render::frames_under_motion(1.0f), 1.0f);
  EXPECT_EQ(render::frames_under_motion(5.0f), 1.0f);
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
  FrameRig fresh(scene_->builder.build(), scene_->from(5.0f), {.extent = extent});
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
