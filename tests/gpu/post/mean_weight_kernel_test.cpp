#include <gtest/gtest.h>

#include "render/passes/post/filter_mean.hpp"
#include "render/passes/post/mean_weight.hpp"
#include "tests/gpu/support/kernel_comparison.hpp"

namespace heliograph::test {
namespace {

/// The weights by the shader and by the host kernel.
class WeightComparison {
 public:
  explicit WeightComparison(VkExtent2D extent)
      : rig_(SceneBuilder().build(), look({0, 0, 3}, {0, 0, 0}), {.extent = extent}) {
    RandomFrame random(rig_);
    const auto radiance = random.four("radiance", glm::vec4(0), glm::vec4(2));
    const auto mean = random.four("mean", glm::vec4(0), glm::vec4(2, 2, 2, 4));
    const auto exposure = render::expose(rig_.plan(), rig_.inputs(), radiance, mean);
    const auto filtered = render::filter_mean(rig_.plan(), rig_.inputs(), exposure, radiance, mean);
    const auto run = [&](bool host) {
      return render::weigh_mean(rig_.plan(), with_host_kernels(rig_, host), exposure, radiance,
                                filtered);
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

class MeanWeightKernel : public testing::TestWithParam<VkExtent2D> {
 protected:
  void SetUp() override {
    if (!has_host_kernels()) GTEST_SKIP() << "host kernels run on CPU devices only";
  }
};

TEST_P(MeanWeightKernel, MatchesShader) {
  WeightComparison comparison(GetParam());
  for (const std::uint32_t samples : {1u, 3u, 12u, 1000u}) {
    const ErrorStatistics result = comparison.after(samples);
    EXPECT_LT(result.max, 1e-5) << samples;
    if (samples >= 12) {
      EXPECT_GT(result.magnitude, 0.05) << samples;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, MeanWeightKernel,
                         testing::Values(VkExtent2D{1, 1}, VkExtent2D{3, 5}, VkExtent2D{17, 31},
                                         VkExtent2D{130, 1}, VkExtent2D{177, 95}),
                         [](const auto& test) {
                           return std::to_string(test.param.width) + "x" +
                                  std::to_string(test.param.height);
                         });

TEST(MeanWeightKernelSpeed, IsFasterThanShader) {
  if (!has_host_kernels()) GTEST_SKIP() << "host kernels run on CPU devices only";
  WeightComparison comparison({1280, 720});
  comparison.rig().set_accumulated(12);
  expect_faster(comparison.rig(), {"mean_weight"}, 1.0);
}

}  // namespace
}  // namespace heliograph::test
