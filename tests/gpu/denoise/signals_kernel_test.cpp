#include <gtest/gtest.h>

#include <glm/gtc/packing.hpp>
#include <limits>

#include "render/kernels/signals.hpp"
#include "render/passes/denoise/denoise_visibility.hpp"
#include "render/passes/post/accumulate.hpp"
#include "render/passes/post/hold_mean.hpp"
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
  const render::FloatImage by_shader = rig.read(shader), by_host = rig.read(host);
  for (std::uint32_t y = 0; y < GetParam().height; ++y) {
    for (std::uint32_t x = 0; x < GetParam().width; ++x) {
      ASSERT_EQ(glm::vec2(texel(by_shader, x, y)), glm::vec2(texel(by_host, x, y)))
          << x << " " << y;
    }
  }
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

TEST_P(SignalKernels, HoldMeanMatchesShader) {
  protocol::Settings settings;
  settings.accumulation.max_samples = 3;
  FrameRig rig(SceneBuilder().build(), camera, {.extent = GetParam(), .settings = settings});
  RandomFrame random(rig);
  const std::size_t pixels = std::size_t{GetParam().width} * GetParam().height;
  std::vector<glm::uvec2> mean;
  std::vector<float> weight;
  std::vector<glm::vec4> frame;
  for (std::size_t i = 0; i < pixels; ++i) {
    mean.emplace_back(glm::packHalf2x16({random.unit(), random.unit()}),
                      glm::packHalf2x16({random.unit(), 0.0f}));
    weight.push_back(random.unit());
    frame.emplace_back(random.unit(), 2.0f, 3.0f, 7.0f);
  }
  const auto mean_image = rig.input("mean", VK_FORMAT_R16G16B16A16_SFLOAT, mean);
  const auto weight_image = rig.input("weight", VK_FORMAT_R32_SFLOAT, weight);
  std::vector<glm::uvec2> frame_in_halves;
  for (const glm::vec4& texel : frame) {
    frame_in_halves.emplace_back(glm::packHalf2x16({texel.x, texel.y}),
                                 glm::packHalf2x16({texel.z, texel.w}));
  }
  const auto run = [&](const char* name, bool host) {
    const auto image = host ? rig.input(name, VK_FORMAT_R32G32B32A32_SFLOAT, frame)
                            : rig.input(name, VK_FORMAT_R16G16B16A16_SFLOAT, frame_in_halves);
    render::hold_mean(rig.plan(), with_host_kernels(rig, host), image, mean_image, weight_image);
    return image;
  };
  const auto shader = run("shader", false), host = run("host", true);
  rig.set_accumulated(1);
  rig.run();
  EXPECT_EQ(texel(rig.read(host), 0, 0), frame[0]) << "the mean is not complete";
  rig.set_accumulated(2);
  rig.run();
  const double rounding = 5e-4;  // of the shader's 16 bits
  EXPECT_LT(compare(rig.read(shader), rig.read(host)).max, rounding);
  const float expected = glm::mix(frame[0].x, glm::unpackHalf2x16(mean[0].x).x, weight[0]);
  EXPECT_NEAR(texel(rig.read(host), 0, 0).x, expected, 1e-6f);
  EXPECT_EQ(texel(rig.read(host), 0, 0).w, 7.0f);

  // The same weight in all pixels takes the place of the image's.
  settings.accumulation.by_noise = false;
  settings.accumulation.blend_samples = 2;
  rig.set_settings(settings);
  rig.fill(host, frame);
  rig.fill(shader, frame_in_halves);
  rig.run();
  EXPECT_LT(compare(rig.read(shader), rig.read(host)).max, rounding);
  const float half = glm::mix(frame[0].x, glm::unpackHalf2x16(mean[0].x).x, 0.5f);
  EXPECT_NEAR(texel(rig.read(host), 0, 0).x, half, 1e-6f);
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
