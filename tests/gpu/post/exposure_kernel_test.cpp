#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "render/passes/post/exposure.hpp"
#include "shaders/shared/exposure.h"
#include "tests/gpu/support/kernel_comparison.hpp"

namespace heliograph::test {
namespace {

const scene::Camera camera = look({0, 0, 3}, {0, 0, 0});

RigOptions options(VkExtent2D extent, bool automatic) {
  RigOptions made{.extent = extent};
  made.settings.exposure.compensation = 0.6f;
  made.settings.exposure.mode =
      automatic ? protocol::ExposureMode::automatic : protocol::ExposureMode::manual;
  return made;
}

/// Exposure by the shaders and by their host kernels.
class KernelComparison {
 public:
  KernelComparison(VkExtent2D extent, bool automatic)
      : rig_(SceneBuilder().build(), camera, options(extent, automatic)), random_(rig_) {
    hdr_ = random_.four("hdr", glm::vec4(0), glm::vec4(3));
    const auto mean = random_.four("mean", glm::vec4(0), glm::vec4(9));
    const auto run = [&](bool host) {
      return render::expose(rig_.plan(), with_host_kernels(rig_, host), hdr_, mean);
    };
    shader_ = run(false);
    host_ = run(true);
    rig_.run();
  }

  FrameRig& rig() { return rig_; }
  shared::ExposureState shader() { return read(shader_); }
  shared::ExposureState host() { return read(host_); }

  /// A frame that is brighter by `factor`, with black and very bright pixels.
  void next(float factor) {
    std::vector<glm::vec4> texels(std::size_t{rig_.plan().extent().width} *
                                  rig_.plan().extent().height);
    for (glm::vec4& texel : texels) {
      const float light = random_.unit() < 0.1f ? 0.0f : factor * std::exp2(12.0f * random_.unit());
      texel = glm::vec4(light, 0.5f * light, random_.unit(), 1.0f);
    }
    rig_.fill(hdr_, texels);
    rig_.set_view(camera);
    rig_.run();
  }

 private:
  shared::ExposureState read(const render::Exposure& from) {
    shared::ExposureState state;
    std::memcpy(&state, rig_.plan().get(from.report).mapped(), sizeof state);
    return state;
  }

  FrameRig rig_;
  RandomFrame random_;
  gpu::ImageRef hdr_;
  render::Exposure shader_, host_;
};

class ExposureKernel : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_host_kernels()) GTEST_SKIP() << "host kernels run on CPU devices only";
  }
};

void expect_same(KernelComparison& comparison, const std::string& which) {
  const shared::ExposureState shader = comparison.shader(), host = comparison.host();
  EXPECT_NEAR(host.factor, shader.factor, 1e-3f * shader.factor) << which;
  EXPECT_NEAR(host.stops, shader.stops, 1e-3f) << which;
  EXPECT_NEAR(host.target, shader.target, 1e-3f) << which;
}

TEST_F(ExposureKernel, MatchesShaders) {
  KernelComparison comparison({177, 95}, true);
  expect_same(comparison, "first frame");
  EXPECT_NE(comparison.host().factor, 0.0f);
  for (const std::uint32_t samples : {0u, 5u, 100000u}) {
    comparison.rig().set_accumulated(samples);
    for (const float factor : {0.001f, 1.0f, 40.0f}) {
      comparison.next(factor);
      expect_same(comparison, std::to_string(samples) + " samples, x " + std::to_string(factor));
    }
  }
}

TEST_F(ExposureKernel, MatchesShadersAtAnySize) {
  for (const VkExtent2D extent : {VkExtent2D{1, 1}, {3, 5}, {16, 2}, {17, 31}, {130, 1}}) {
    KernelComparison comparison(extent, true);
    comparison.next(2.0f);
    expect_same(comparison, std::to_string(extent.width) + " x " + std::to_string(extent.height));
  }
}

TEST_F(ExposureKernel, ManualIsTheSame) {
  KernelComparison comparison({17, 31}, false);
  expect_same(comparison, "manual");
}

TEST_F(ExposureKernel, IsFasterThanShaders) {
  KernelComparison comparison({640, 360}, true);
  expect_faster(comparison.rig(), {"exposure.begin", "exposure.meter", "exposure.adapt"}, 1.5);
}

}  // namespace
}  // namespace heliograph::test
