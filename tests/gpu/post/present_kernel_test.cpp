#include <gtest/gtest.h>

#include "render/kernels/present.hpp"
#include "render/passes/post/present.hpp"
#include "tests/gpu/support/kernel_comparison.hpp"

namespace heliograph::test {
namespace {

const scene::Camera camera = look({0, 0, 3}, {0, 0, 0});

RigOptions options(VkExtent2D extent, protocol::ToneMapCurve curve) {
  RigOptions made{.extent = extent};
  made.settings.tone_map.curve = curve;
  made.settings.exposure.compensation = -0.4f;
  return made;
}

/// The finished picture twice over, by the shader and by its twin.
class Twins {
 public:
  Twins(VkExtent2D extent, protocol::ToneMapCurve curve)
      : rig_(SceneBuilder().build(), camera, options(extent, curve)) {
    RandomFrame random(rig_);
    const auto radiance = random.four("radiance", glm::vec4(-0.1f), glm::vec4(2));
    const auto mean = random.four("mean", glm::vec4(0), glm::vec4(12));
    const auto exposure = render::expose(rig_.plan(), rig_.inputs(), radiance, mean);
    const auto run = [&](bool host) {
      return render::present(rig_.plan(), with_kernels(rig_, host), exposure, radiance, mean);
    };
    shader_ = run(false);
    host_ = run(true);
  }

  FrameRig& rig() { return rig_; }
  Compared compared() { return compare(rig_.read(shader_), rig_.read(host_)); }

 private:
  FrameRig rig_;
  gpu::ImageRef shader_, host_;
};

class PresentKernel : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_host_kernels()) GTEST_SKIP() << "host kernels are for devices that are processors";
  }
};

TEST_F(PresentKernel, MatchesShader) {
  using protocol::ToneMapCurve;
  for (const auto curve :
       {ToneMapCurve::neutral, ToneMapCurve::aces, ToneMapCurve::agx, ToneMapCurve::linear}) {
    Twins twins({177, 95}, curve);
    for (const std::uint32_t samples : {0u, 5u, 100000u}) {
      twins.rig().set_accumulated(samples);
      twins.rig().run();
      const Compared result = twins.compared();
      EXPECT_LT(result.worst, 1.01 / 255.0) << "a code value: " << static_cast<int>(curve);
      EXPECT_LT(result.mean, 0.02 / 255.0) << "of hardly any pixel";
      EXPECT_GT(result.size, 0.2);
    }
  }
}

TEST_F(PresentKernel, MatchesShaderAtAnySize) {
  for (const VkExtent2D extent : {VkExtent2D{1, 1}, {3, 5}, {16, 2}, {17, 31}, {130, 1}}) {
    Twins twins(extent, protocol::ToneMapCurve::neutral);
    twins.rig().run();
    EXPECT_LT(twins.compared().worst, 1.01 / 255.0) << extent.width << " x " << extent.height;
  }
}

TEST_F(PresentKernel, IsFasterThanShader) {
  Twins twins({1280, 720}, protocol::ToneMapCurve::neutral);
  expect_faster(twins.rig(), {"present"}, 1.0);
}

}  // namespace
}  // namespace heliograph::test
