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

/// Reprojection twice over, by the shader and by its twin.
class Twins {
 public:
  explicit Twins(VkExtent2D extent, bool orthographic = false)
      : rig_(SceneBuilder().build(), camera(orthographic), {.extent = extent}) {
    RandomFrame random(rig_);
    const render::GBuffer gbuffer = random.gbuffer();
    shader_ = render::reproject(rig_.plan(), with_kernels(rig_, false), gbuffer);
    host_ = render::reproject(rig_.plan(), with_kernels(rig_, true), gbuffer);
  }

  FrameRig& rig() { return rig_; }
  Compared guide() { return compare(rig_.read(shader_.surface), rig_.read(host_.surface)); }
  Compared map() { return compare(rig_.read(shader_.reprojection), rig_.read(host_.reprojection)); }
  /// Pixels that were found by their bilinear neighbours, by another neighbour, and not at all.
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
    if (!has_host_kernels()) GTEST_SKIP() << "host kernels are for devices that are processors";
  }
};

void expect_same(Twins& twins, const std::string& which) {
  const Compared guide = twins.guide(), map = twins.map();
  EXPECT_LT(guide.worst, 1e-5) << which;
  EXPECT_LT(map.mean, 1e-3) << which;
  EXPECT_LT(map.apart, 1e-3) << "but for a test that rounding decides: " << which;
}

TEST_F(ReprojectKernel, MatchesShader) {
  for (const bool orthographic : {false, true}) {
    Twins twins({177, 95}, orthographic);
    twins.rig().run();
    expect_same(twins, "nothing before");
    twins.rig().set_view(camera(orthographic), 1);
    twins.rig().run();
    expect_same(twins, orthographic ? "orthographic" : "perspective");
    EXPECT_GT(twins.outcomes().x, 2000);
    EXPECT_GT(twins.outcomes().y, 20);
    EXPECT_GT(twins.outcomes().z, 20);
  }
}

TEST_F(ReprojectKernel, MatchesShaderAtAnySize) {
  for (const VkExtent2D extent : {VkExtent2D{1, 1}, {3, 5}, {16, 2}, {17, 31}, {130, 1}}) {
    Twins twins(extent);
    twins.rig().set_view(camera(false), 1);
    twins.rig().run();
    expect_same(twins, std::to_string(extent.width) + " wide");
  }
}

TEST_F(ReprojectKernel, IsFasterThanShader) {
  Twins twins({640, 360});
  twins.rig().set_view(camera(false), 1);
  expect_faster(twins.rig(), {"denoise.reproject"}, 2.0);
}

}  // namespace
}  // namespace heliograph::test
