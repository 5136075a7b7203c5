#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "render/kernels/visibility_rays.hpp"
#include "render/passes/visibility/trace_visibility.hpp"
#include "shaders/shared/sampling.h"
#include "tests/gpu/support/kernel_comparison.hpp"

namespace heliograph::test {
namespace {

/// Lights on all sides, about half of them occluded by leaves.
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
  scene.add_point_light({4, 3, 5}, {40, 50, 60}, 0.3f)
      .add_point_light({-5, -2, 3}, {90, 80, 70}, 0.5f);
  return scene.build();
}

const scene::Camera camera = look({0, 0, 3}, {0, 0, 0});

/// Shadow and ambient visibility by the shaders and by the host kernels.
class KernelComparison {
 public:
  /// With a plan a quarter of the pixels trace shadow rays, half of them ambient rays.
  explicit KernelComparison(VkExtent2D extent, bool with_plan = false)
      : rig_(leafy_scene(), camera, {.extent = extent}) {
    RandomFrame random(rig_);
    const render::GBuffer gbuffer = random.gbuffer();
    std::optional<gpu::ImageRef> planned;
    if (with_plan) {
      std::vector<std::uint32_t> words(std::size_t{extent.width} * extent.height);
      for (std::uint32_t& word : words) {
        word = (random.unit() < 0.25f ? shared::plan_shadows : 0u) |
               (random.unit() < 0.5f ? shared::plan_ambient : 0u) | 0x1234u;
      }
      planned = rig_.input("planned", VK_FORMAT_R32_UINT, words);
    }
    for (const bool host : {false, true}) {
      const auto in = with_host_kernels(rig_, host);
      signals_.push_back(render::trace_shadows(rig_.plan(), in, gbuffer, planned));
      signals_.push_back(render::trace_ambient(rig_.plan(), in, gbuffer, planned));
    }
    rig_.set_view(camera, 5);
    rig_.run();
  }

  FrameRig& rig() { return rig_; }
  ErrorStatistics shadows() { return compare(rig_.read(signals_[0]), rig_.read(signals_[2])); }
  ErrorStatistics ambient() { return compare(rig_.read(signals_[1]), rig_.read(signals_[3])); }

  /// Ray counts of all passes named `pass`, in order of execution.
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
    if (!has_host_kernels()) GTEST_SKIP() << "host kernels run on CPU devices only";
  }
};

TEST_F(VisibilityRaysKernel, MatchesShaders) {
  KernelComparison comparison({177, 95});
  for (const ErrorStatistics& result : {comparison.shadows(), comparison.ambient()}) {
    EXPECT_LT(result.outliers, 2e-3) << "more differences than rays that graze an edge";
    EXPECT_GT(result.magnitude, 0.2);
    EXPECT_LT(result.magnitude, 0.9);
  }
  for (const char* pass : {"shadows.trace", "ambient.trace"}) {
    const auto rays = comparison.rays(pass);
    ASSERT_EQ(rays.size(), 2u);
    EXPECT_GT(rays[0], 1000u);
    EXPECT_NEAR(static_cast<double>(rays[0]), static_cast<double>(rays[1]), 3.0);
  }
}

TEST_F(VisibilityRaysKernel, MatchesShadersUnderAPlan) {
  KernelComparison whole({177, 95});
  KernelComparison comparison({177, 95}, true);
  EXPECT_LT(comparison.shadows().outliers, 2e-3);
  EXPECT_LT(comparison.ambient().outliers, 2e-3);
  for (const auto& [pass, fraction] :
       {std::pair("shadows.trace", 0.25), std::pair("ambient.trace", 0.5)}) {
    const auto all = whole.rays(pass), rays = comparison.rays(pass);
    EXPECT_NEAR(static_cast<double>(rays[0]), static_cast<double>(rays[1]), 3.0);
    EXPECT_NEAR(static_cast<double>(rays[1]) / static_cast<double>(all[1]), fraction, 0.02);
  }
}

TEST_F(VisibilityRaysKernel, MatchesShadersAtAnySize) {
  for (const VkExtent2D extent : {VkExtent2D{1, 1}, {3, 5}, {16, 2}, {17, 31}, {130, 1}}) {
    KernelComparison comparison(extent);
    EXPECT_LT(comparison.shadows().outliers, 3e-3) << extent.width << " x " << extent.height;
    EXPECT_LT(comparison.ambient().outliers, 3e-3) << extent.width << " x " << extent.height;
  }
}

TEST_F(VisibilityRaysKernel, IsFasterThanShaders) {
  KernelComparison comparison({640, 360});
  expect_faster(comparison.rig(), {"shadows.rays", "ambient.rays"}, 2.0);
}

}  // namespace
}  // namespace heliograph::test
