#include <gtest/gtest.h>

#include <limits>

#include "render/kernels/temporal.hpp"
#include "render/passes/denoise/temporal.hpp"
#include "tests/gpu/support/kernel_comparison.hpp"

namespace heliograph::test {
namespace {

struct View {
  VkExtent2D extent{77, 45};
  bool orthographic = false;
  render::SceneMotion motion = {};
  protocol::Settings settings;
};

scene::Camera camera(const View& view, float turn) {
  scene::Camera made = look({0, 0, 3}, {turn, 0, 0});
  if (view.orthographic) made.orthographic_height = 4.0f;
  return made;
}

/// Both signals' accumulation, with the variance of those that are short, twice over: by the
/// shaders and by their twins, each from its own memory.
class Twins {
 public:
  explicit Twins(const View& view)
      : view_(view),
        rig_(SceneBuilder().build(), camera(view, 0.0f),
             {.extent = view.extent, .settings = view.settings}),
        random_(rig_) {
    const render::GBuffer gbuffer = random_.gbuffer();
    raw_visibility_ = random_.four("visibility", glm::vec4(0), glm::vec4(1));
    raw_specular_ = random_.four("specular", glm::vec4(0), glm::vec4(2));
    const render::Guide guide = render::reproject(rig_.plan(), rig_.inputs(), gbuffer);
    for (const bool host : {false, true}) {
      const auto in = with_kernels(rig_, host);
      auto& plan = rig_.plan();
      visibility_.push_back(render::accumulate_visibility(plan, in, guide, raw_visibility_, false));
      specular_.push_back(
          render::accumulate_specular(plan, in, gbuffer, guide, raw_specular_, false));
      render::estimate_visibility_variance(plan, in, gbuffer, guide, visibility_.back());
      render::estimate_specular_variance(plan, in, gbuffer, guide, specular_.back());
    }
  }

  FrameRig& rig() { return rig_; }

  /// A frame of another noise, turned a little; a few samples are no numbers, as they may be.
  void next() {
    rig_.set_scene_motion(view_.motion);
    const std::size_t count = std::size_t{view_.extent.width} * view_.extent.height;
    std::vector<glm::vec4> visibility(count), specular(count);
    for (std::size_t i = 0; i < count; ++i) {
      visibility[i] = {random_.unit() < 0.4f, random_.unit() < 0.7f, 0.0f, 0.0f};
      const float firefly = random_.unit() < 0.02f ? 30.0f : 1.0f;
      specular[i] = firefly * glm::vec4(random_.unit(), random_.unit(), 2.0f * random_.unit(), 0);
      specular[i].w = random_.unit() < 0.1f ? 0.0f : 5.0f * random_.unit();
      if (random_.unit() < 0.01f) specular[i].x = std::numeric_limits<float>::quiet_NaN();
      if (random_.unit() < 0.01f) specular[i].w = std::numeric_limits<float>::infinity();
    }
    rig_.fill(raw_visibility_, visibility);
    rig_.fill(raw_specular_, specular);
    ++frames_;
    rig_.set_view(camera(view_, 0.01f * static_cast<float>(frames_)), frames_);
    rig_.run();
  }

  /// All images that a signal leaves behind, the shader's against the host's.
  std::vector<Compared> compared() {
    std::vector<Compared> all;
    for (const auto& signals : {visibility_, specular_}) {
      for (const auto image : {&render::Integrated::signal, &render::Integrated::moments,
                               &render::Integrated::history}) {
        all.push_back(compare(rig_.read(signals[0].*image), rig_.read(signals[1].*image)));
      }
    }
    return all;
  }

 private:
  View view_;
  FrameRig rig_;
  RandomFrame random_;
  gpu::ImageRef raw_visibility_, raw_specular_;
  std::vector<render::Integrated> visibility_, specular_;
  std::uint32_t frames_ = 0;
};

class TemporalHost : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_host_kernels()) GTEST_SKIP() << "host kernels are for devices that are processors";
  }
};

void expect_same(Twins& twins, const std::string& which) {
  int image = 0;
  for (const Compared& result : twins.compared()) {
    const std::string name = which + ", image " + std::to_string(image++);
    EXPECT_LT(result.mean, 1e-3) << name;
    EXPECT_LT(result.apart, 4e-3) << "but for a test that rounding decides: " << name;
    EXPECT_GT(result.size, 0.05) << name;
  }
}

void expect_same_over_frames(const View& view, const std::string& which) {
  Twins twins(view);
  twins.rig().run();
  expect_same(twins, which + ", nothing before");
  for (int i = 1; i < 5; ++i) {
    twins.next();
    // Rounding decides whether such a history is long enough to tell its variance.
    if (i + 1 == view.settings.specular_temporal.spatial_variance_frames) continue;
    expect_same(twins, which + ", frame " + std::to_string(i));
  }
}

TEST_F(TemporalHost, DoesWhatTheShadersDo) {
  expect_same_over_frames({}, "as set");
  expect_same_over_frames({.orthographic = true}, "orthographic");
}

TEST_F(TemporalHost, FollowsEverySetting) {
  View view;
  view.settings.shadow_temporal.mean_variance = view.settings.specular_temporal.mean_variance =
      false;
  view.settings.specular_temporal.virtual_motion = false;
  expect_same_over_frames(view, "own history, variance of samples");

  view = {};
  view.settings.shadow_temporal.bicubic = view.settings.specular_temporal.bicubic = false;
  view.settings.specular_temporal.curved_reflectors = false;
  expect_same_over_frames(view, "bilinear, mirrors as if they were flat");

  view = {};
  view.settings.shadow_temporal.rectification = view.settings.specular_temporal.rectification =
      protocol::Rectification::off;
  expect_same_over_frames(view, "not rectified");

  view = {};
  view.settings.shadow_temporal.rectification_radius = 1;
  view.settings.specular_temporal.rectification_radius = 5;
  view.settings.specular_temporal.rectification_scale = 0.5f;
  expect_same_over_frames(view, "other windows");

  view = {.motion = {.things = true}};
  view.settings.shadow_temporal.rectification = view.settings.specular_temporal.rectification =
      protocol::Rectification::gradient;
  expect_same_over_frames(view, "gradients");

  expect_same_over_frames({.motion = {.lights = 0.05f, .environment = 0.2f}}, "lights on the way");
}

TEST_F(TemporalHost, LeavesOtherRectificationsToTheShaders) {
  View view;
  view.settings.shadow_temporal.rectification = protocol::Rectification::color_clamp;
  view.settings.specular_temporal.rectification = protocol::Rectification::percentile;
  Twins twins(view);
  twins.rig().run();
  for (const auto& timing : twins.rig().plan().timings()) {
    EXPECT_FALSE(timing.host && timing.name.ends_with(".temporal")) << timing.name;
  }
}

TEST_F(TemporalHost, WorksAtEverySize) {
  for (const VkExtent2D extent : {VkExtent2D{1, 1}, {3, 5}, {16, 2}, {17, 31}, {130, 1}}) {
    Twins twins({.extent = extent});
    twins.rig().run();
    twins.next();
    for (const Compared& result : twins.compared()) {
      EXPECT_LT(result.mean, 5e-3) << extent.width << " x " << extent.height;
    }
  }
}

TEST_F(TemporalHost, IsFasterThanTheShaders) {
  Twins twins({.extent = {640, 360}});
  twins.rig().run();
  twins.next();
  expect_faster(twins.rig(),
                {"visibility.temporal", "visibility.rectify", "specular.temporal",
                 "specular.rectify", "visibility.variance", "specular.variance"},
                2.0);
}

}  // namespace
}  // namespace heliograph::test
