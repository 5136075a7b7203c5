#include <gtest/gtest.h>

#include "render/passes/ground/ground.hpp"
#include "render/passes/reference/reference.hpp"
#include "tests/gpu/support/kernel_comparison.hpp"
#include "tests/gpu/support/layered_scene.hpp"

namespace heliograph::test {
namespace {

scene::MaterialLayers colored_prism(SceneBuilder&) {
  return {.transmission = 0.9f,
          .thickness = 0.4f,
          .attenuation_distance = 0.5f,
          .attenuation_color = {0.8f, 0.6f, 0.9f},
          .dispersion = 2.0f};
}

/// A sample of full global illumination by the shader and by the host kernel.
class PathComparison {
 public:
  explicit PathComparison(const LayeredCase& which, int bounces, VkExtent2D extent = {150, 100})
      : rig_(layered_scene(which), layered_camera(which), options(bounces, extent)) {
    for (const bool host : {false, true}) {
      const render::FrameInputs& in = with_host_kernels(rig_, host);
      const gpu::BufferRef ground = render::trace_ground(rig_.plan(), in);
      samples_[host] = render::trace_reference(rig_.plan(), in, ground);
    }
    rig_.set_view(layered_camera(which), 6);
    rig_.run();
  }

  FrameRig& rig() { return rig_; }
  ErrorStatistics error() const { return compare(shader(), kernel()); }

  /// Relative difference of the means. A value counts as at most 10.
  double difference_of_means() const {
    const auto mean = [](const render::FloatImage& image) {
      double sum = 0.0;
      for (const float value : image.rgba) sum += std::min(value, 10.0f);
      return sum / static_cast<double>(image.rgba.size());
    };
    return std::abs(mean(kernel()) / mean(shader()) - 1.0);
  }

 private:
  static RigOptions options(int bounces, VkExtent2D extent) {
    RigOptions made{.extent = extent, .environment = colored_environment()};
    made.tracer = "embree";
    made.settings.reference.use = protocol::ReferenceUse::always;
    made.settings.reference.scope = protocol::ReferenceScope::full;
    made.settings.reference.bounces = bounces;
    return made;
  }

  render::FloatImage shader() const { return rig_.read(samples_[0]); }
  render::FloatImage kernel() const { return rig_.read(samples_[1]); }

  FrameRig rig_;
  std::array<gpu::ImageRef, 2> samples_;
};

class TracePathsKernel : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_host_kernels()) GTEST_SKIP() << "host kernels run on CPU devices only";
  }
};

TEST_F(TracePathsKernel, MatchesShader) {
  const std::pair<const char*, LayeredCase> cases[] = {
      {"plain", {}},
      {"orthographic", {.orthographic = true}},
      {"areas", {.areas = true}},
      {"emissive", {.shines = true}},
      {"coat", {.layers = coat}},
      {"sheen", {.layers = sheen}},
      {"specular", {.layers = specular}},
      {"film", {.layers = film}},
      {"brushed", {.layers = brushed}},
      {"brushed film, textured", {.layers = brushed_film, .areas = true, .shines = true}},
      {"diffuse transmission", {.layers = diffuse_transmission}},
      {"diffuse transmission, textured, emissive",
       {.layers = textured_diffuse_transmission, .areas = true, .shines = true}},
      {"diffuse transmission, scaled", {.layers = textured_diffuse_transmission, .scale = 2.5f}},
      {"all, textured, emissive", {.layers = all_of_them, .areas = true, .shines = true}}};
  for (const auto& [name, which] : cases) {
    for (const int bounces : {1, 4}) {
      const PathComparison comparison(which, bounces);
      const ErrorStatistics error = comparison.error();
      // Rounding may send a ray past an edge or select another light, at each vertex.
      EXPECT_LT(error.outliers, 6e-3 * (1 + bounces)) << name << ", " << bounces << " bounces";
      EXPECT_LT(comparison.difference_of_means(), 0.01) << name << ", " << bounces << " bounces";
      EXPECT_GT(error.magnitude, 0.1) << name << " is black";
    }
  }
}

TEST_F(TracePathsKernel, MatchesShaderBehindBlendedSurfaces) {
  const std::pair<const char*, LayeredCase> cases[] = {
      {"plain", {.alpha = 0.6f}},
      {"transmission", {.layers = transmission}},
      {"dispersion", {.layers = colored_prism}},
      {"layers", {.layers = all_of_them, .areas = true, .alpha = 0.6f, .shines = true}}};
  for (const auto& [name, which] : cases) {
    // Bits of the rays decide what stops them: means are all that can be compared.
    EXPECT_LT(PathComparison(which, 4).difference_of_means(), 0.02) << name;
  }
}

TEST_F(TracePathsKernel, MatchesShaderAtAnySize) {
  for (const VkExtent2D extent : {VkExtent2D{17, 31}, {130, 7}}) {
    PathComparison comparison({.layers = coat, .areas = true}, 2, extent);
    comparison.rig().run();  // more than one frame
    EXPECT_LT(comparison.error().outliers, 0.02) << extent.width << " x " << extent.height;
  }
}

TEST_F(TracePathsKernel, IsFasterThanShader) {
  PathComparison comparison({.layers = all_of_them, .areas = true}, 4, {640, 360});
  expect_faster(comparison.rig(), {"reference.camera", "reference.bounce", "reference.add"}, 2.0);
}

}  // namespace
}  // namespace heliograph::test
