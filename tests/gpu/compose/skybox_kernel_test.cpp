#include <gtest/gtest.h>

#include "render/passes/compose/skybox.hpp"
#include "tests/gpu/support/kernel_comparison.hpp"

namespace heliograph::test {
namespace {

struct View {
  VkExtent2D extent{77, 45};
  bool orthographic = false;
  bool visible = true;
  bool sun = false;  // in the middle of a frame without surfaces
};

/// Smooth, so that a filter's rounding shows less than a wrong texel.
scene::Environment sky(bool sun) {
  return make_environment(sun ? 256 : 64, [sun](const glm::vec3& d) {
    const bool bright = sun && glm::dot(d, glm::vec3(0, 0, -1)) > 0.999f;
    return glm::vec3(1.0f + d.y, 0.5f + 0.4f * d.x * d.z, 1.0f - d.x) +
           glm::vec3(bright ? 3000.0f : 0.0f);
  });
}

RigOptions options(const View& view) {
  RigOptions made{.extent = view.extent, .environment = sky(view.sun)};
  made.settings.environment.visible = view.visible;
  made.settings.environment.rotation = view.sun ? 0.0f : 130.0f;
  made.settings.environment.intensity = 1.5f;
  return made;
}

scene::Camera camera(bool orthographic) {
  scene::Camera made = look({0, 0, 3}, {0, 0, 0});
  if (orthographic) made.orthographic_height = 4.0f;
  return made;
}

/// The background by the shader and by its host kernel.
class KernelComparison {
 public:
  explicit KernelComparison(const View& view)
      : rig_(SceneBuilder().build(), camera(view.orthographic), options(view)) {
    render::GBuffer gbuffer = RandomFrame(rig_).gbuffer();
    if (view.sun) gbuffer.motion = RandomFrame(rig_).four("none", glm::vec4(0), glm::vec4(0));
    const auto run = [&](bool host) {
      return render::draw_skybox(rig_.plan(), with_host_kernels(rig_, host), gbuffer);
    };
    shader_ = run(false);
    host_ = run(true);
    rig_.run();
  }

  FrameRig& rig() { return rig_; }
  ErrorStatistics statistics() { return compare(rig_.read(shader_), rig_.read(host_)); }
  render::FloatImage host() { return rig_.read(host_); }

 private:
  FrameRig rig_;
  gpu::ImageRef shader_, host_;
};

class SkyboxKernel : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_host_kernels()) GTEST_SKIP() << "host kernels run on CPU devices only";
  }
};

TEST_F(SkyboxKernel, MatchesShader) {
  for (const bool orthographic : {false, true}) {
    for (const bool sun : {false, true}) {
      KernelComparison comparison({.orthographic = orthographic, .sun = sun});
      const ErrorStatistics result = comparison.statistics();
      // At the rim of the sun, 3000 times as bright as the sky, a coordinate's rounding shows.
      EXPECT_LT(result.mean, sun ? 1e-3 : 1e-4) << orthographic << sun;
      EXPECT_LT(result.outliers, sun ? 5e-3 : 1e-9) << orthographic << sun;
      EXPECT_GT(result.magnitude, 0.3) << "alpha is 1 everywhere";
    }
  }
}

TEST_F(SkyboxKernel, ShowsTheSunThatIsALightOfItsOwn) {
  float brightest = 0.0f;
  for (const float value : KernelComparison({.sun = true}).host().rgba) {
    brightest = std::max(brightest, value);
  }
  EXPECT_GT(brightest, 1000.0f);
}

TEST_F(SkyboxKernel, IsBlackBehindSurfacesAndWhereInvisible) {
  KernelComparison comparison({.visible = false});
  EXPECT_EQ(comparison.statistics().max, 0.0);
  const render::FloatImage image = comparison.host();
  for (std::uint32_t i = 0; i < image.width * image.height; ++i) {
    EXPECT_EQ(image.rgba[4 * i] + image.rgba[4 * i + 1] + image.rgba[4 * i + 2], 0.0f);
  }
}

TEST_F(SkyboxKernel, MatchesShaderAtAnySize) {
  for (const VkExtent2D extent : {VkExtent2D{1, 1}, {3, 5}, {16, 2}, {17, 31}, {130, 1}}) {
    EXPECT_LT(KernelComparison({.extent = extent}).statistics().max, 5e-3) << extent.width;
  }
}

TEST_F(SkyboxKernel, IsFasterThanShader) {
  KernelComparison comparison({.extent = {640, 360}});
  expect_faster(comparison.rig(), {"skybox"}, 2.0);
}

}  // namespace
}  // namespace heliograph::test
