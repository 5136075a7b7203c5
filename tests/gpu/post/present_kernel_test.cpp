#include <gtest/gtest.h>

#include "render/kernels/post/present.hpp"
#include "render/passes/post/filter_mean.hpp"
#include "render/passes/post/mean_weight.hpp"
#include "render/passes/post/present.hpp"
#include "tests/gpu/support/kernel_comparison.hpp"

namespace heliograph::test {
namespace {

const scene::Camera camera = look({0, 0, 3}, {0, 0, 0});

RigOptions options(VkExtent2D extent, protocol::ToneMapCurve curve,
                   std::optional<VkExtent2D> shown) {
  RigOptions made{.extent = extent, .shown = shown};
  made.settings.tone_map.curve = curve;
  made.settings.exposure.compensation = -0.4f;
  return made;
}

/// Presentation by the shader and by its host kernel.
class KernelComparison {
 public:
  KernelComparison(VkExtent2D extent, protocol::ToneMapCurve curve,
                   std::optional<VkExtent2D> shown = std::nullopt)
      : rig_(SceneBuilder().build(), camera, options(extent, curve, shown)) {
    RandomFrame random(rig_);
    const auto radiance = random.four("radiance", glm::vec4(-0.1f), glm::vec4(2));
    const auto mean = random.four("mean", glm::vec4(0), glm::vec4(12));
    const auto exposure = render::expose(rig_.plan(), rig_.inputs(), radiance, mean);
    const auto filtered = render::filter_mean(rig_.plan(), rig_.inputs(), exposure, radiance, mean);
    const auto weight =
        render::weigh_mean(rig_.plan(), rig_.inputs(), exposure, radiance, filtered);
    const auto run = [&](bool host) {
      return render::present(rig_.plan(), with_host_kernels(rig_, host), exposure, radiance,
                             filtered, weight);
    };
    shader_ = run(false);
    host_ = run(true);
  }

  FrameRig& rig() { return rig_; }
  /// All pixels show as much of the mean, as the number of samples says.
  void weigh_alike() {
    protocol::Settings settings = rig_.inputs().settings;
    settings.accumulation.by_noise = false;
    settings.accumulation.blend_samples = 8;
    rig_.set_settings(settings);
  }
  ErrorStatistics statistics() { return compare(rig_.read(shader_), rig_.read(host_)); }

 private:
  FrameRig rig_;
  gpu::ImageRef shader_, host_;
};

class PresentKernel : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_host_kernels()) GTEST_SKIP() << "host kernels run on CPU devices only";
  }
};

TEST_F(PresentKernel, MatchesShader) {
  using protocol::ToneMapCurve;
  for (const auto curve :
       {ToneMapCurve::neutral, ToneMapCurve::aces, ToneMapCurve::agx, ToneMapCurve::linear}) {
    KernelComparison comparison({177, 95}, curve);
    for (const std::uint32_t samples : {0u, 5u, 100000u}) {
      comparison.rig().set_accumulated(samples);
      comparison.rig().run();
      const ErrorStatistics result = comparison.statistics();
      EXPECT_LT(result.max, 1.01 / 255.0)
          << "more than one code value: " << static_cast<int>(curve);
      EXPECT_LT(result.mean, 0.02 / 255.0) << "in too many pixels";
      EXPECT_GT(result.magnitude, 0.2);
    }
  }
}

TEST_F(PresentKernel, MatchesShaderWhereAllPixelsWeighTheMeanAlike) {
  KernelComparison comparison({177, 95}, protocol::ToneMapCurve::neutral);
  comparison.weigh_alike();
  double without = 0.0;
  for (const std::uint32_t samples : {0u, 8u, 100000u}) {
    comparison.rig().set_accumulated(samples);
    comparison.rig().run();
    const ErrorStatistics result = comparison.statistics();
    EXPECT_LT(result.max, 1.01 / 255.0) << samples;
    EXPECT_LT(result.mean, 0.02 / 255.0) << samples;
    if (samples == 0) without = result.magnitude;
    if (samples > 0) {
      EXPECT_GT(result.magnitude, without + 0.03) << "the mean is brighter: " << samples;
    }
  }
}

TEST_F(PresentKernel, MatchesShaderAtAnySize) {
  for (const VkExtent2D extent : {VkExtent2D{1, 1}, {3, 5}, {16, 2}, {17, 31}, {130, 1}}) {
    KernelComparison comparison(extent, protocol::ToneMapCurve::neutral);
    comparison.rig().run();
    EXPECT_LT(comparison.statistics().max, 1.01 / 255.0) << extent.width << " x " << extent.height;
  }
}

TEST_F(PresentKernel, ShowsTheNearestPixelsOfSmallerFrames) {
  for (const VkExtent2D shown : {VkExtent2D{177, 95}, {150, 80}, {103, 61}, {7, 300}}) {
    const VkExtent2D drawn{std::min(shown.width, 100u), std::min(shown.height, 60u)};
    KernelComparison comparison(drawn, protocol::ToneMapCurve::neutral, shown);
    comparison.rig().run();
    const ErrorStatistics result = comparison.statistics();
    EXPECT_LT(result.max, 1.01 / 255.0) << shown.width << " x " << shown.height;
    EXPECT_GT(result.magnitude, 0.2);
  }
}

TEST_F(PresentKernel, IsFasterThanShader) {
  KernelComparison comparison({1280, 720}, protocol::ToneMapCurve::neutral);
  expect_faster(comparison.rig(), {"present"}, 1.0);
}

}  // namespace
}  // namespace heliograph::test
