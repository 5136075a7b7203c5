#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

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
  float left_out = 0.0f;  // fraction of pixels without a sample
};

scene::Camera camera(const View& view, float turn) {
  scene::Camera made = look({0, 0, 3}, {turn, 0, 0});
  if (view.orthographic) made.orthographic_height = 4.0f;
  return made;
}

/// Temporal accumulation of both signals and spatial variance of short histories, by the shaders
/// and by the host kernels, each with its own history.
class KernelComparison {
 public:
  explicit KernelComparison(const View& view)
      : view_(view),
        rig_(SceneBuilder().build(), camera(view, 0.0f),
             {.extent = view.extent, .settings = view.settings}),
        random_(rig_) {
    const render::GBuffer gbuffer = random_.gbuffer();
    raw_visibility_ = random_.four("visibility", glm::vec4(0), glm::vec4(1));
    raw_specular_ = random_.four("specular", glm::vec4(0), glm::vec4(2));
    const render::Guide guide = render::reproject(rig_.plan(), rig_.inputs(), gbuffer);
    for (const bool host : {false, true}) {
      const auto in = with_host_kernels(rig_, host);
      auto& plan = rig_.plan();
      const auto histories = render::declare_sample_histories(plan, {});
      visibility_.push_back(
          render::accumulate_visibility(plan, in, guide, histories, raw_visibility_));
      specular_.push_back(render::accumulate_radiance(
          plan, in, gbuffer, guide, render::specular_channel(in, histories), raw_specular_));
      render::estimate_visibility_variance(plan, in, gbuffer, guide, visibility_.back());
      render::estimate_radiance_variance(plan, in, gbuffer, guide,
                                         render::specular_channel(in, histories), specular_.back());
    }
  }

  FrameRig& rig() { return rig_; }

  /// A frame of different noise from a slightly rotated camera; a few samples are NaN or infinite.
  void next() {
    rig_.set_scene_motion(view_.motion);
    const std::size_t count = std::size_t{view_.extent.width} * view_.extent.height;
    std::vector<glm::vec4> visibility(count), specular(count);
    for (std::size_t i = 0; i < count; ++i) {
      visibility[i] = {random_.unit() < 0.4f, random_.unit() < 0.7f, 0.0f, 0.0f};
      const float firefly = random_.unit() < 0.02f ? 30.0f : 1.0f;
      specular[i] = firefly * glm::vec4(random_.unit(), random_.unit(), 2.0f * random_.unit(), 0);
      specular[i].w = random_.unit() < 0.1f ? 0.0f : 5.0f * random_.unit();
      if (random_.unit() < view_.left_out) visibility[i] = {-1, -1, 0, 0};
      if (random_.unit() < view_.left_out) specular[i] = {0, 0, 0, -5.0f * random_.unit()};
      if (random_.unit() < 0.01f) specular[i].x = std::numeric_limits<float>::quiet_NaN();
      if (random_.unit() < 0.01f) specular[i].w = std::numeric_limits<float>::infinity();
    }
    rig_.fill(raw_visibility_, visibility);
    rig_.fill(raw_specular_, specular);
    ++frames_;
    rig_.set_view(camera(view_, 0.01f * static_cast<float>(frames_)), frames_);
    rig_.run();
  }

  /// All output images of both signals, shader against host kernel.
  std::vector<ErrorStatistics> statistics() {
    std::vector<ErrorStatistics> all;
    for (const auto& signals : {visibility_, specular_}) {
      for (const auto image :
           {&render::AccumulatedSignal::signal, &render::AccumulatedSignal::moments,
            &render::AccumulatedSignal::history_length, &render::AccumulatedSignal::history}) {
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
  std::vector<render::AccumulatedSignal> visibility_, specular_;
  std::uint32_t frames_ = 0;
};

class TemporalKernel : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_host_kernels()) GTEST_SKIP() << "host kernels run on CPU devices only";
  }
};

void expect_same(const std::vector<ErrorStatistics>& statistics, const std::string& which) {
  int image = 0;
  for (const ErrorStatistics& result : statistics) {
    const std::string name = which + ", image " + std::to_string(image++);
    EXPECT_LT(result.mean, 1e-3) << name;
    EXPECT_LT(result.outliers, 4e-3) << "more differences than rounding explains: " << name;
    EXPECT_GT(result.magnitude, 0.05) << name;
  }
}

/// Of each image, the mean over frames.
std::vector<ErrorStatistics> mean_of(const std::vector<std::vector<ErrorStatistics>>& frames) {
  std::vector<ErrorStatistics> means(frames.front().size());
  const double share = 1.0 / static_cast<double>(frames.size());
  for (const auto& frame : frames) {
    for (std::size_t i = 0; i < means.size(); ++i) {
      means[i].mean += share * frame[i].mean;
      means[i].outliers += share * frame[i].outliers;
      means[i].magnitude += share * frame[i].magnitude;
    }
  }
  return means;
}

/// Rounding, which is different on every processor, decides whether a pixel on the limit of a test
/// keeps its history, and this pixel is in the windows of up to 288 others. All frames together
/// have to be the same but for few of these, and each but for one or two.
void expect_same_over_frames(const View& view, const std::string& which) {
  KernelComparison comparison(view);
  comparison.rig().run();
  expect_same(comparison.statistics(), which + ", no history");
  std::vector<std::vector<ErrorStatistics>> frames;
  for (int i = 1; i < 5; ++i) {
    comparison.next();
    // Rounding decides whether this history is long enough for temporal variance.
    if (i + 1 == view.settings.specular_temporal.spatial_variance_frames) continue;
    frames.push_back(comparison.statistics());
    for (const ErrorStatistics& result : frames.back()) {
      EXPECT_LT(result.outliers, 0.02) << which << ", frame " << i;
    }
  }
  expect_same(mean_of(frames), which + ", frames with history");
}

TEST_F(TemporalKernel, MatchesShaders) {
  expect_same_over_frames({}, "default settings");
  expect_same_over_frames({.orthographic = true}, "orthographic");
}

TEST_F(TemporalKernel, MatchesShadersWhereSamplesAreLeftOut) {
  for (const float left_out : {0.4f, 0.8f}) {
    View view{.left_out = left_out};
    view.settings.shadow_temporal.spatial_variance_frames =
        view.settings.specular_temporal.spatial_variance_frames = 0;
    view.motion.geometry_moved = true;
    expect_same_over_frames(view, "gradient");
    view.settings.shadow_temporal.rectification = view.settings.specular_temporal.rectification =
        protocol::Rectification::fast_history;
    expect_same_over_frames(view, "fast history");
  }
}

TEST_F(TemporalKernel, MatchesShadersForEverySetting) {
  View view;
  view.settings.shadow_temporal.mean_variance = view.settings.specular_temporal.mean_variance =
      false;
  view.settings.specular_temporal.virtual_motion = false;
  expect_same_over_frames(view, "own history, variance of samples");

  view = {};
  view.settings.shadow_temporal.bicubic = view.settings.specular_temporal.bicubic = false;
  view.settings.specular_temporal.curved_reflectors = false;
  expect_same_over_frames(view, "bilinear, planar reflectors");

  view = {};
  view.settings.shadow_temporal.rectification = view.settings.specular_temporal.rectification =
      protocol::Rectification::off;
  expect_same_over_frames(view, "not rectified");

  view = {};
  view.settings.shadow_temporal.rectification_radius = 1;
  view.settings.specular_temporal.rectification_radius = 5;
  view.settings.specular_temporal.rectification_scale = 0.5f;
  expect_same_over_frames(view, "other windows");
  view.settings.shadow_temporal.rectification_radius = 8;
  view.settings.specular_temporal.rectification_radius = 8;
  expect_same_over_frames(view, "the largest windows");

  view = {.motion = {.geometry_moved = true}};
  view.settings.shadow_temporal.rectification = view.settings.specular_temporal.rectification =
      protocol::Rectification::gradient;
  expect_same_over_frames(view, "gradients");

  expect_same_over_frames({.motion = {.lights = 0.05f, .environment = 0.2f}}, "moving lights");
}

TEST_F(TemporalKernel, UnsupportedRectificationsRunOnDevice) {
  View view;
  view.settings.shadow_temporal.rectification = protocol::Rectification::color_clamp;
  view.settings.specular_temporal.rectification = protocol::Rectification::percentile;
  KernelComparison comparison(view);
  comparison.rig().run();
  for (const auto& timing : comparison.rig().plan().timings()) {
    EXPECT_FALSE(timing.host && timing.name.ends_with(".temporal")) << timing.name;
  }
}

TEST_F(TemporalKernel, MatchesShadersAtAnySize) {
  for (const VkExtent2D extent : {VkExtent2D{1, 1}, {3, 5}, {16, 2}, {17, 31}, {130, 1}}) {
    KernelComparison comparison({.extent = extent});
    comparison.rig().run();
    comparison.next();
    for (const ErrorStatistics& result : comparison.statistics()) {
      EXPECT_LT(result.mean, 5e-3) << extent.width << " x " << extent.height;
    }
  }
}

TEST_F(TemporalKernel, IsFasterThanShaders) {
  KernelComparison comparison({.extent = {640, 360}});
  comparison.rig().run();
  comparison.next();
  expect_faster(comparison.rig(),
                {"visibility.temporal", "visibility.rectify", "specular.temporal",
                 "specular.rectify", "visibility.variance", "specular.variance"},
                2.0);
}

}  // namespace
}  // namespace heliograph::test
