#include <gtest/gtest.h>

#include "render/passes/post/filter_mean.hpp"
#include "tests/gpu/support/kernel_comparison.hpp"

namespace heliograph::test {
namespace {

/// The filtered mean by the shader and by the host kernel.
class FilterComparison {
 public:
  FilterComparison(VkExtent2D extent, bool filters)
      : rig_(SceneBuilder().build(), look({0, 0, 3}, {0, 0, 0}), {.extent = extent}) {
    protocol::Settings settings;
    settings.accumulation.filter = filters;
    rig_.set_settings(settings);
    RandomFrame random(rig_);
    // Differences as large as the noise of ten samples, so that patches are like and unlike.
    const auto radiance = random.four("radiance", glm::vec4(0.5f), glm::vec4(0.9f));
    const auto mean = random.four("mean", glm::vec4(0.5f), glm::vec4(0.9f, 0.9f, 0.9f, 0.6f));
    const auto exposure = render::expose(rig_.plan(), rig_.inputs(), radiance, mean);
    const auto run = [&](bool host) {
      return render::filter_mean(rig_.plan(), with_host_kernels(rig_, host), exposure, radiance,
                                 mean);
    };
    shader_ = run(false);
    host_ = run(true);
  }

  FrameRig& rig() { return rig_; }
  ErrorStatistics after(std::uint32_t samples) {
    rig_.set_accumulated(samples);
    rig_.run();
    return compare(rig_.read(shader_), rig_.read(host_));
  }

 private:
  FrameRig rig_;
  gpu::ImageRef shader_, host_;
};

class FilterMeanKernel : public testing::TestWithParam<VkExtent2D> {
 protected:
  void SetUp() override {
    if (!has_host_kernels()) GTEST_SKIP() << "host kernels run on CPU devices only";
  }
};

TEST_P(FilterMeanKernel, MatchesShader) {
  for (const bool filters : {true, false}) {
    FilterComparison comparison(GetParam(), filters);
    for (const std::uint32_t samples : {3u, 12u, 1000u}) {
      const ErrorStatistics result = comparison.after(samples);
      EXPECT_LT(result.max, 0x1p-10) << "more than two steps of a half float: " << samples;
      EXPECT_GT(result.magnitude, 0.2) << samples;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, FilterMeanKernel,
                         testing::Values(VkExtent2D{1, 1}, VkExtent2D{3, 5}, VkExtent2D{17, 31},
                                         VkExtent2D{130, 1}, VkExtent2D{177, 95}),
                         [](const auto& test) {
                           return std::to_string(test.param.width) + "x" +
                                  std::to_string(test.param.height);
                         });

TEST(FilterMeanKernelSpeed, IsFasterThanShader) {
  if (!has_host_kernels()) GTEST_SKIP() << "host kernels run on CPU devices only";
  FilterComparison comparison({640, 360}, true);
  comparison.rig().set_accumulated(12);
  expect_faster(comparison.rig(), {"filter_mean"}, 1.0);
}

}  // namespace
}  // namespace heliograph::test
