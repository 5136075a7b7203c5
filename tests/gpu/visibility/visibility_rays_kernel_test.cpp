#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "render/kernels/visibility_rays.hpp"
#include "render/passes/visibility/trace_visibility.hpp"
#include "tests/gpu/support/kernel_comparison.hpp"

namespace heliograph::test {
namespace {

/// Lights all about, of which a surface sees some, between leaves that hide half of everything.
std::shared_ptr<const scene::Scene> leafy_scene() {
  SceneBuilder scene;
  const auto leaf = scene.add_quad(
      {glm::vec3(-0.2f, -0.2f, 0), {0.2f, -0.2f, 0}, {0.2f, 0.2f, 0}, {-0.2f, 0.2f, 0}},
      surface(glm::vec3(0.5f)));
  for (int i = 0; i < 300; ++i) {
    const float a = 2.4f * static_cast<float>(i), up = static_cast<float>(i) / 100.0f - 1.5f;
    const glm::vec3 place(3.0f * std::sin(a), up, 3.0f * std::cos(a));
    scene.place(leaf, glm::rotate(glm::translate(glm::mat4(1.0f), place), a, glm::vec3(0, 1, 0)));
  }
  scene.add_sun({0.3f, -0.5f, -1.0f}, {3, 2, 1}, 4.0f);
  scene.add_lamp({4, 3, 5}, {40, 50, 60}, 0.3f).add_lamp({-5, -2, 3}, {90, 80, 70}, 0.5f);
  return scene.build();
}

const scene::Camera camera = look({0, 0, 3}, {0, 0, 0});

/// Both kinds of visibility twice over, made by shaders and by their twins.
class Twins {
 public:
  explicit Twins(VkExtent2D extent) : rig_(leafy_scene(), camera, {.extent = extent}) {
    RandomFrame random(rig_);
    const render::GBuffer gbuffer = random.gbuffer();
    for (const bool host : {false, true}) {
      const auto in = with_kernels(rig_, host);
      signals_.push_back(render::trace_shadows(rig_.plan(), in, gbuffer));
      signals_.push_back(render::trace_ambient(rig_.plan(), in, gbuffer));
    }
    rig_.set_view(camera, 5);
    rig_.run();
  }

  FrameRig& rig() { return rig_; }
  Compared shadows() { return compare(rig_.read(signals_[0]), rig_.read(signals_[2])); }
  Compared ambient() { return compare(rig_.read(signals_[1]), rig_.read(signals_[3])); }

  /// Entries of the streams that passes of this name work on, in order.
  std::vector<std::uint64_t> rays(const std::string& pass) {
    std::vector<std::uint64_t> found;
    for (const auto& work : rig_.plan().work()) {
      if (work.name == pass) found.push_back(work.entries);
    }
    return found;
  }

 private:
  FrameRig rig_;
  std::vector<gpu::ImageRef> signals_;
};

class VisibilityRaysKernel : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_host_kernels()) GTEST_SKIP() << "host kernels are for devices that are processors";
  }
};

TEST_F(VisibilityRaysKernel, MatchesShaders) {
  Twins twins({177, 95});
  for (const Compared& result : {twins.shadows(), twins.ambient()}) {
    EXPECT_LT(result.apart, 2e-3) << "but for rays that graze an edge";
    EXPECT_GT(result.size, 0.2);
    EXPECT_LT(result.size, 0.9);
  }
  for (const char* pass : {"shadows.trace", "ambient.trace"}) {
    const auto rays = twins.rays(pass);
    ASSERT_EQ(rays.size(), 2u);
    EXPECT_GT(rays[0], 1000u);
    EXPECT_NEAR(static_cast<double>(rays[0]), static_cast<double>(rays[1]), 3.0);
  }
}

TEST_F(VisibilityRaysKernel, MatchesShadersAtAnySize) {
  for (const VkExtent2D extent : {VkExtent2D{1, 1}, {3, 5}, {16, 2}, {17, 31}, {130, 1}}) {
    Twins twins(extent);
    EXPECT_LT(twins.shadows().apart, 3e-3) << extent.width << " x " << extent.height;
    EXPECT_LT(twins.ambient().apart, 3e-3) << extent.width << " x " << extent.height;
  }
}

TEST_F(VisibilityRaysKernel, IsFasterThanShaders) {
  Twins twins({640, 360});
  expect_faster(twins.rig(), {"shadows.rays", "ambient.rays"}, 2.0);
}

}  // namespace
}  // namespace heliograph::test
