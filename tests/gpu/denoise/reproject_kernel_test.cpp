#include <gtest/gtest.h>

#include <cmath>

#include "render/kernels/reproject.hpp"
#include "render/passes/denoise/reproject.hpp"
#include "tests/gpu/support/kernel_comparison.hpp"

namespace heliograph::test {
namespace {

scene::Camera camera(bool orthographic) {
  scene::Camera made = look({0, 0, 3}, {0, 0, 0});
  if (orthographic) made.orthographic_height = 4.0f;
  return made;
}

/// Reprojection by the shader and by its host kernel.
class KernelComparison {
 public:
  explicit KernelComparison(VkExtent2D extent, bool orthographic = false)
      : rig_(SceneBuilder().build(), camera(orthographic), {.extent = extent}) {
    RandomFrame random(rig_);
    const render::GBuffer gbuffer = random.gbuffer();
    shader_ = render::reproject(rig_.plan(), with_host_kernels(rig_, false), gbuffer);
    host_ = render::reproject(rig_.plan(), with_host_kernels(rig_, true), gbuffer);
  }

  FrameRig& rig() { return rig_; }
  ErrorStatistics guide() { return compare(rig_.read(shader_.surface), rig_.read(host_.surface)); }
  ErrorStatistics map() {
    return compare(rig_.read(shader_.reprojection), rig_.read(host_.reprojection));
  }
  /// Counts of pixels with bilinear history, with history at a single neighbor, and disoccluded.
  glm::ivec3 outcomes() {
    glm::ivec3 count(0);
    const render::FloatImage map = rig_.read(host_.reprojection);
    for (std::size_t i = 0; i < map.rgba.size(); i += 4) {
      const bool exact = map.rgba[i] == std::floor(map.rgba[i]) + 0.5f;
      ++(map.rgba[i + 3] > 0.0f ? count.z : exact ? count.y : count.x);
    }
    return count;
  }

 private:
  FrameRig rig_;
  render::Guide shader_, host_;
};

class ReprojectKernel : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_host_kernels()) GTEST_SKIP() << "host kernels run on CPU devices only";
  }
};

void expect_same(KernelComparison& comparison, const std::string& which) {
  const ErrorStatistics guide = comparison.guide(), map = comparison.map();
  EXPECT_LT(guide.max, 1e-5) << which;
  EXPECT_LT(map.mean, 1e-3) << which;
  EXPECT_LT(map.outliers, 1e-3) << "more differences than rounding explains: " << which;
}

TEST_F(ReprojectKernel, MatchesShader) {
  for (const bool orthographic : {false, true}) {
    KernelComparison comparison({177, 95}, orthographic);
    comparison.rig().run();
    expect_same(comparison, "no history");
    comparison.rig().set_view(camera(orthographic), 1);
    comparison.rig().run();
    expect_same(comparison, orthographic ? "orthographic" : "perspective");
    EXPECT_GT(comparison.outcomes().x, 2000);
    EXPECT_GT(comparison.outcomes().y, 20);
    EXPECT_GT(comparison.outcomes().z, 20);
  }
}

TEST_F(ReprojectKernel, MatchesShaderAtAnySize) {
  for (const VkExtent2D extent : {VkExtent2D{1, 1}, {3, 5}, {16, 2}, {17, 31}, {130, 1}}) {
    KernelComparison comparison(extent);
    comparison.rig().set_view(camera(false), 1);
    comparison.rig().run();
    expect_same(comparison, std::to_string(extent.width) + " wide");
  }
}

TEST_F(ReprojectKernel, IsFasterThanShader) {
  KernelComparison comparison({640, 360});
  comparison.rig().set_view(camera(false), 1);
  expect_faster(comparison.rig(), {"reproject"}, 2.0);
}

}  // namespace
}  // namespace heliograph::test
