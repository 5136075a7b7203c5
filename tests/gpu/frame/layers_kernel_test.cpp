#include <gtest/gtest.h>

#include "render/passes/blend/blend_surfaces.hpp"
#include "render/passes/gbuffer/draw_gbuffer.hpp"
#include "render/passes/gbuffer/trace_gbuffer.hpp"
#include "render/passes/reflections/trace_specular.hpp"
#include "render/passes/visibility/trace_visibility.hpp"
#include "tests/gpu/support/kernel_comparison.hpp"
#include "tests/gpu/support/layered_scene.hpp"

namespace heliograph::test {
namespace {

/// All that a surface goes through, by the shaders and by the host kernels.
class KernelComparison {
 public:
  explicit KernelComparison(const LayeredCase& which, VkExtent2D extent = {150, 100})
      : rig_(layered_scene(which), layered_camera(which), options(which, extent)),
        random_(!which.unoccluded) {
    gbuffers_ = {render::trace_gbuffer(rig_.plan(), with_host_kernels(rig_, false)),
                 render::trace_gbuffer(rig_.plan(), with_host_kernels(rig_, true)),
                 render::draw_gbuffer(rig_.plan(), with_host_kernels(rig_, true))};
    // Of one G-buffer, whose rounding would send rays elsewhere.
    for (const bool host : {false, true}) sides_.push_back(declare(host, gbuffers_[1]));
    if (render::has_blends(rig_.inputs())) declare_drawn_blends();
    for (const render::GBuffer& gbuffer : gbuffers_) {
      composed_.push_back(compose(false, gbuffer, sides_[0]).hdr);
    }
    rig_.set_view(layered_camera(which), 6);
    rig_.run();
  }

  FrameRig& rig() { return rig_; }

  void expect_equal(const std::string& which) const {
    for (const std::size_t i : {1u, 2u}) {
      const std::string what = which + (i == 1 ? ": traced" : ": drawn");
      // What is composed of them tells their layers.
      expect_equal(what, composed_[0], composed_[i], 8e-3);
      expect_equal(what + " surface", gbuffers_[0].surface, gbuffers_[i].surface, 4e-3);
    }
    // Rounding may send a ray past an edge or select another light.
    expect_equal(which + ": shadows", sides_[0].shadows, sides_[1].shadows, 6e-3);
    expect_equal(which + ": reflections", sides_[0].specular, sides_[1].specular, 6e-3);
    expect_equal(which + ": composed", sides_[0].hdr, sides_[1].hdr, 6e-3);
  }

  /// Of surfaces that nothing occludes and the frame that they blend over.
  void expect_equal_blends(const std::string& which) const {
    expect_equal(which + ": composed", sides_[0].hdr, sides_[1].hdr, 6e-3);
    // Samples on edges may belong to other triangles, in each of several layers.
    expect_equal(which + ": drawn", sides_[1].hdr, sides_[2].hdr, 2e-2);
    expect_equal(which + ": drawn, motion", sides_[1].motion, sides_[2].motion, 2e-2);
  }

  /// Where bits of the rays decide what stops them, means are all that can be compared.
  void expect_equal_means(const std::string& which) const {
    const auto mean = [this](gpu::ImageRef image) {
      double sum = 0.0;
      const render::FloatImage read = rig_.read(image);
      for (const float value : read.rgba) sum += std::min(std::abs(value), 10.0f);
      return sum / static_cast<double>(read.rgba.size());
    };
    for (const auto signal : {&Side::shadows, &Side::specular, &Side::hdr}) {
      const double expected = mean(sides_[0].*signal);
      EXPECT_NEAR(mean(sides_[1].*signal), expected, 0.01 * expected) << which;
    }
    const double expected = mean(sides_[1].hdr);
    EXPECT_NEAR(mean(sides_[2].hdr), expected, 0.01 * expected) << which << ", drawn";
  }

 private:
  struct Side {
    gpu::ImageRef shadows, specular, hdr, motion;
  };

  static RigOptions options(const LayeredCase& which, VkExtent2D extent) {
    RigOptions made{.extent = extent, .environment = colored_environment()};
    made.settings.specular.max_roughness = 0.4f;  // some surfaces reflect the environment alone
    made.settings.specular.enabled = made.settings.shadows.enabled =
        made.settings.ambient.occlusion = !which.unoccluded;
    made.settings.transmission.refraction = !which.unoccluded;
    return made;
  }
  render::Composed compose(bool host, const render::GBuffer& gbuffer, const Side& side) {
    gpu::FramePlan& plan = rig_.plan();
    const gpu::ImageRef background = plan.image("background", VK_FORMAT_R32G32B32A32_SFLOAT);
    plan.get(background).clear();
    const render::NoisySignals noisy{side.shadows, side.shadows,
                                     random_ ? std::optional(side.specular) : std::nullopt};
    return render::compose(plan, with_host_kernels(rig_, host), gbuffer, noisy, std::nullopt,
                           background);
  }

  /// Of the rasteriser's G-buffer, with what it has laid over on the way.
  void declare_drawn_blends() {
    const render::BlendedImages images = render::declare_blended(rig_.plan());
    const render::GBuffer drawn =
        render::draw_gbuffer(rig_.plan(), with_host_kernels(rig_, true), &images);
    sides_.push_back(declare(true, drawn, &images));
  }

  Side declare(bool host, const render::GBuffer& gbuffer,
               const render::BlendedImages* blended = nullptr) {
    const render::FrameInputs& in = with_host_kernels(rig_, host);
    gpu::FramePlan& plan = rig_.plan();
    Side side;
    side.shadows = render::trace_shadows(plan, in, gbuffer, {});
    side.specular = render::trace_specular(plan, in, gbuffer, {});
    const render::Composed composed = compose(host, gbuffer, side);
    side.motion = render::blend_surfaces(plan, in, gbuffer, composed, {}, blended);
    side.hdr = composed.hdr;
    return side;
  }

  void expect_equal(const std::string& what, gpu::ImageRef shader, gpu::ImageRef host,
                    double outliers) const {
    const ErrorStatistics error = compare(rig_.read(shader), rig_.read(host));
    EXPECT_LT(error.mean, 0.3 * outliers) << what;
    EXPECT_LT(error.outliers, outliers) << what;
    EXPECT_GT(error.magnitude, 0.02) << what << " is black";
  }

  FrameRig rig_;
  bool random_;
  std::vector<render::GBuffer> gbuffers_;  // by the shaders, by the kernels, drawn
  std::vector<Side> sides_;  // by the shaders, by the kernels; if anything is blended: drawn
  std::vector<gpu::ImageRef> composed_;  // of each G-buffer, by the shader
};

class LayersKernel : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_host_kernels()) GTEST_SKIP() << "host kernels run on CPU devices only";
  }
};

TEST_F(LayersKernel, MatchesShadersForEveryLayer) {
  const std::pair<const char*, scene::MaterialLayers (*)(SceneBuilder&)> layers[] = {
      {"coat", coat},
      {"sheen", sheen},
      {"specular", specular},
      {"film", film},
      {"brushed", brushed},
      {"brushed film, textured", brushed_film},
      {"diffuse transmission", diffuse_transmission},
      {"diffuse transmission, textured", textured_diffuse_transmission},
      {"all, textured", all_of_them}};
  for (const auto& [name, made] : layers) {
    KernelComparison({.layers = made}).expect_equal(name);
  }
  KernelComparison({.layers = all_of_them, .orthographic = true}).expect_equal("orthographic");
  KernelComparison({.layers = film, .orthographic = true}).expect_equal("film, orthographic");
  KernelComparison({.layers = textured_diffuse_transmission, .scale = 2.5f})
      .expect_equal("diffuse transmission, scaled");
}

TEST_F(LayersKernel, MatchesShadersForAreaLights) {
  KernelComparison({.areas = true}).expect_equal("plain");
  KernelComparison({.layers = all_of_them, .areas = true}).expect_equal("layers");
  KernelComparison({.layers = brushed_film, .areas = true}).expect_equal("brushed film");
  KernelComparison({.layers = textured_diffuse_transmission, .areas = true})
      .expect_equal("diffuse transmission");
}

TEST_F(LayersKernel, MatchesShadersForBlendedSurfaces) {
  const std::pair<const char*, LayeredCase> cases[] = {
      {"plain", {.alpha = 0.6f}},
      {"orthographic", {.alpha = 0.6f, .orthographic = true}},
      {"transmission", {.layers = transmission}},
      {"transmission, scaled", {.layers = transmission, .scale = 2.5f}},
      {"diffuse transmission", {.layers = diffuse_transmission, .areas = true, .alpha = 0.6f}},
      {"layers", {.layers = all_of_them, .areas = true, .alpha = 0.6f}}};
  for (auto [name, which] : cases) {
    KernelComparison(which).expect_equal_means(name);
    which.unoccluded = true;
    KernelComparison(which).expect_equal_blends(name);
  }
}

TEST_F(LayersKernel, MatchesShadersAtAnySize) {
  for (const VkExtent2D extent : {VkExtent2D{17, 31}, {130, 7}}) {
    KernelComparison comparison({.layers = coat, .areas = true, .alpha = 0.6f}, extent);
    comparison.rig().run();  // more than one frame
  }
}

TEST_F(LayersKernel, IsFasterThanShaders) {
  KernelComparison comparison({.layers = all_of_them, .areas = true}, {640, 360});
  expect_faster(comparison.rig(),
                {"gbuffer.hits", "shadows.rays", "specular.rays", "specular.shade", "compose"},
                2.0);
}

}  // namespace
}  // namespace heliograph::test
