#include <gtest/gtest.h>

#include <limits>

#include "render/kernels/signals.hpp"
#include "render/passes/denoise/denoise_visibility.hpp"
#include "render/passes/post/accumulate.hpp"
#include "tests/gpu/support/kernel_comparison.hpp"

namespace heliograph::test {
namespace {

const scene::Camera camera = look({0, 0, 3}, {0, 0, 0});

class SignalKernels : public testing::TestWithParam<VkExtent2D> {
 protected:
  void SetUp() override {
    if (!has_host_kernels()) GTEST_SKIP() << "host kernels run on CPU devices only";
  }
};

TEST_P(SignalKernels, CombineVisibilityMatchesShader) {
  FrameRig rig(SceneBuilder().build(), camera, {.extent = GetParam()});
  RandomFrame random(rig);
  const auto shadows = random.bits("shadows"), ambient = random.bits("ambient");
  std::vector<float> broken(std::size_t{GetParam().width} * GetParam().height, 0.75f);
  broken[0] = std::numeric_limits<float>::quiet_NaN();
  broken.back() = std::numeric_limits<float>::infinity();
  rig.fill(ambient, broken);
  const auto run = [&](bool host) {
    return render::combine_visibility(rig.plan(), with_host_kernels(rig, host), shadows, ambient);
  };
  const auto shader = run(false), host = run(true);
  rig.run();
  EXPECT_EQ(rig.read(shader).rgba, rig.read(host).rgba);
}

TEST_P(SignalKernels, AccumulateMatchesShader) {
  FrameRig rig(SceneBuilder().build(), camera, {.extent = GetParam()});
  RandomFrame random(rig);
  const auto sample = random.four("sample", glm::vec4(0), glm::vec4(5));
  const auto run = [&](bool host) {
    return render::accumulate(rig.plan(), with_host_kernels(rig, host), sample).current;
  };
  const auto shader = run(false), host = run(true);
  for (std::uint32_t samples = 0; samples < 4; ++samples) {
    rig.set_accumulated(samples);
    rig.fill(sample, std::vector<glm::vec4>(std::size_t{GetParam().width} * GetParam().height,
                                            glm::vec4(random.unit(), 2.0f, 3.0f, 1.0f)));
    rig.run();
    const ErrorStatistics result = compare(rig.read(shader), rig.read(host));
    EXPECT_LT(result.max, 1e-6) << samples;
    EXPECT_GT(result.magnitude, 1.0) << samples;
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, SignalKernels,
                         testing::Values(VkExtent2D{1, 1}, VkExtent2D{17, 31}, VkExtent2D{130, 1},
                                         VkExtent2D{177, 95}),
                         [](const auto& test) {
                           return std::to_string(test.param.width) + "x" +
                                  std::to_string(test.param.height);
                         });

}  // namespace
}  // namespace heliograph::test
