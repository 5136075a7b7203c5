#include <gtest/gtest.h>

#include "render/kernels/post/temporal_antialias.hpp"
#include "render/passes/post/temporal_antialias.hpp"
#include "tests/gpu/support/kernel_comparison.hpp"

namespace heliograph::test {
namespace {

struct View {
  VkExtent2D extent{77, 45};
  bool orthographic = false;
  bool anti_flicker = true;
  std::optional<VkExtent2D> shown = std::nullopt;
};

scene::Camera camera(const View& view, float turn) {
  scene::Camera made = look({0, 0, 3}, {turn, 0, 0});
  if (view.orthographic) made.orthographic_height = 4.0f;
  return made;
}

RigOptions options(const View& view) {
  RigOptions made{.extent = view.extent, .shown = view.shown};
  made.settings.reference.use = protocol::ReferenceUse::when_static;
  made.settings.antialiasing.anti_flicker = view.anti_flicker;
  made.settings.exposure.compensation = 0.7f;
  return made;
}

/// Temporal antialiasing by the shader and by its host kernel.
class KernelComparison {
 public:
  explicit KernelComparison(const View& view)
      : view_(view),
        rig_(SceneBuilder().build(), camera(view, 0.0f), options(view)),
        random_(rig_) {
    const render::GBuffer gbuffer = random_.gbuffer();
    radiance_ = random_.four("radiance", glm::vec4(0), glm::vec4(3));
    const auto exposure = render::expose(rig_.plan(), rig_.inputs(), radiance_, radiance_);
    const auto run = [&](bool host) {
      return render::temporal_antialias(rig_.plan(), with_host_kernels(rig_, host), gbuffer,
                                        exposure, radiance_);
    };
    shader_ = run(false);
    host_ = run(true);
  }

  FrameRig& rig() { return rig_; }
  ErrorStatistics statistics() { return compare(rig_.read(shader_), rig_.read(host_)); }

  /// Of the shader and of the host kernel.
  std::pair<render::FloatImage, render::FloatImage> images() {
    return {rig_.read(shader_), rig_.read(host_)};
  }

  /// A frame of different noise from a slightly rotated camera.
  void next() {
    std::vector<glm::vec4> texels(std::size_t{view_.extent.width} * view_.extent.height);
    for (glm::vec4& texel : texels) {
      const float firefly = random_.unit() < 0.02f ? 50.0f : 1.0f;
      texel = firefly * glm::vec4(random_.unit(), 2.0f * random_.unit(), random_.unit(), 1.0f);
    }
    rig_.fill(radiance_, texels);
    ++frames_;
    rig_.set_view(camera(view_, 0.02f * static_cast<float>(frames_)), frames_);
    rig_.run();
  }

 private:
  View view_;
  FrameRig rig_;
  RandomFrame random_;
  gpu::ImageRef radiance_, shader_, host_;
  std::uint32_t frames_ = 0;
};

class TemporalAntialiasKernel : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_host_kernels()) GTEST_SKIP() << "host kernels run on CPU devices only";
  }
};

// Shaders keep 16 bits of a channel, rounded in turn; kernels keep 32.
constexpr double half_step = 1.0 / 1024.0, mean_rounding = 2e-4;

TEST_F(TemporalAntialiasKernel, MatchesShader) {
  for (const bool orthographic : {false, true}) {
    for (const bool anti_flicker : {false, true}) {
      KernelComparison comparison({.orthographic = orthographic, .anti_flicker = anti_flicker});
      comparison.rig().run();
      EXPECT_LT(comparison.statistics().max, half_step) << "without history";
      for (int i = 0; i < 4; ++i) {
        comparison.next();
        const ErrorStatistics result = comparison.statistics();
        EXPECT_LT(result.mean, mean_rounding) << i;
        EXPECT_LT(result.outliers, 1e-3)
            << "more differences than rounding at the border explains: " << i;
        EXPECT_GT(result.magnitude, 0.3);
      }
    }
  }
}

TEST_F(TemporalAntialiasKernel, HoldsTheHistoryWhileSamplesArePathTraced) {
  KernelComparison comparison({});
  comparison.rig().run();
  comparison.next();
  const auto before = comparison.images();
  comparison.rig().let_reference_take_over();
  comparison.next();
  EXPECT_EQ(comparison.images().first.rgba, before.first.rgba) << "shader";
  EXPECT_EQ(comparison.images().second.rgba, before.second.rgba) << "host kernel";
}

TEST_F(TemporalAntialiasKernel, MatchesShaderAtAnySize) {
  for (const VkExtent2D extent : {VkExtent2D{1, 1}, {3, 5}, {16, 2}, {17, 31}, {130, 1}}) {
    KernelComparison comparison({.extent = extent});
    comparison.rig().run();
    comparison.next();
    comparison.next();
    EXPECT_LT(comparison.statistics().mean, 2e-4) << extent.width << " x " << extent.height;
  }
}

TEST_F(TemporalAntialiasKernel, MatchesShaderWhereFramesAreDrawnSmaller) {
  for (const auto& [drawn, shown] : {std::pair<VkExtent2D, VkExtent2D>{{77, 45}, {96, 56}},
                                     {{77, 45}, {115, 67}},
                                     {{77, 45}, {154, 90}},
                                     {{3, 5}, {6, 10}},
                                     {{16, 1}, {33, 2}}}) {
    KernelComparison comparison({.extent = drawn, .shown = shown});
    comparison.rig().run();
    EXPECT_LT(comparison.statistics().mean, mean_rounding) << "without history " << shown.width;
    for (int i = 0; i < 4; ++i) comparison.next();
    const ErrorStatistics result = comparison.statistics();
    EXPECT_LT(result.mean, 1e-3) << shown.width << " x " << shown.height;
    EXPECT_LT(result.outliers, 4e-3)
        << "more differences than rounding between two samples explains: " << shown.width;
  }
}

TEST_F(TemporalAntialiasKernel, IsFasterThanShader) {
  KernelComparison comparison({.extent = {640, 360}});
  comparison.rig().run();
  comparison.next();
  expect_faster(comparison.rig(), {"temporal_antialias"}, 2.0);
}

}  // namespace
}  // namespace heliograph::test
