#include <gtest/gtest.h>

#include "render/passes/gbuffer/trace_gbuffer.hpp"
#include "render/passes/indirect/trace_indirect.hpp"
#include "tests/gpu/support/kernel_comparison.hpp"

namespace heliograph::test {
namespace {

/// A sphere in the corner of a bright and a dark wall, with sun and a point light. `leaf`: and a
/// leaf that lets light through.
std::shared_ptr<const scene::Scene> lit_corner(bool leaf) {
  SceneBuilder builder;
  if (leaf) {
    shared::Material green = surface({0.1f, 0.6f, 0.2f}, 0.6f);
    green.flags = shared::material_double_sided;
    const auto material = builder.with_layers(
        green, {.diffuse_transmission = 0.7f, .diffuse_transmission_color = {0.8f, 0.9f, 0.2f}});
    builder.place(builder.add_quad(
        {{{-1, 0.5f, 1.5f}, {2, 0.5f, 1.5f}, {2, 2.5f, 0}, {-1, 2.5f, 0}}}, material));
  }
  builder.place(builder.add_quad({{{-3, -1, 3}, {3, -1, 3}, {3, -1, -3}, {-3, -1, -3}}},
                                 surface({0.8f, 0.7f, 0.6f})));
  builder.place(builder.add_quad({{{-3, -1, -3}, {3, -1, -3}, {3, 3, -3}, {-3, 3, -3}}},
                                 surface({0.9f, 0.2f, 0.1f}, 0.5f)));
  builder.place(builder.add_quad({{{-3, -1, 3}, {-3, -1, -3}, {-3, 3, -3}, {-3, 3, 3}}},
                                 surface({0.2f, 0.3f, 0.9f}, 0.4f, 0.8f)));
  builder.place(builder.add_sphere(0.8f, surface({0.5f, 0.5f, 0.5f}, 0.7f)));
  builder.add_sun({0.6f, -1.0f, -0.8f}, {3, 2.5f, 2}, 1.0f);
  builder.add_point_light({1, 2, 1}, {2, 3, 4}, 0.1f);
  return builder.build();
}

/// Indirect light of the same frames by the shaders and by the host kernels, each with a cache of
/// its own.
class IndirectComparison {
 public:
  explicit IndirectComparison(const protocol::Settings& settings = {}, bool leaf = false)
      : rig_(lit_corner(leaf), camera(), {.extent = {96, 64}, .settings = settings}),
        gbuffer_(render::trace_gbuffer(rig_.plan(), with_host_kernels(rig_, true))),
        shader_(trace(false)),
        host_(trace(true)) {
    rig_.invalidate_history();  // the caches are empty
  }

  /// Frames from `first` to before `last`.
  void run(std::uint32_t first, std::uint32_t last) {
    for (std::uint32_t i = first; i < last; ++i) {
      rig_.set_view(camera(), i);
      rig_.run();
    }
  }
  render::FloatImage shader() const { return rig_.read(shader_); }
  render::FloatImage host() const { return rig_.read(host_); }

 private:
  static scene::Camera camera() { return look({3, 1.5f, 4}, {-0.5f, 0, -0.5f}, 50.0f); }
  gpu::ImageRef trace(bool host) {
    const render::FrameInputs& in = with_host_kernels(rig_, host);
    const render::RadianceCache cache = render::update_radiance_cache(rig_.plan(), in);
    return render::trace_indirect(rig_.plan(), in, gbuffer_, cache, {});
  }

  FrameRig rig_;
  render::GBuffer gbuffer_;
  gpu::ImageRef shader_, host_;
};

struct Sums {
  glm::dvec3 light{0.0};
  double sampled = 0.0;  // fraction of pixels
};

Sums sums(const render::FloatImage& image) {
  Sums made;
  const double pixels = double(image.rgba.size()) / 4.0;
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
    for (int c = 0; c < 3; ++c) made.light[c] += image.rgba[i + std::size_t(c)] / pixels;
    if (image.rgba[i + 3] >= 0.0f) made.sampled += 1.0 / pixels;
  }
  return made;
}

class IndirectKernel : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_host_kernels()) GTEST_SKIP() << "host kernels run on CPU devices only";
  }
};

// In the first frame no cell is known: what misses takes the environment, all else no sample.
TEST_F(IndirectKernel, MatchesShadersWithoutCells) {
  IndirectComparison comparison;
  comparison.run(0, 1);
  const ErrorStatistics error = compare(comparison.shader(), comparison.host());
  EXPECT_LT(error.mean, 2e-3);
  EXPECT_LT(error.outliers, 6e-3);
  const double sampled = sums(comparison.host()).sampled;
  EXPECT_GT(sampled, 0.2);
  EXPECT_LT(sampled, 0.9);
}

/// Shaders make cells in another order and place them elsewhere: only means agree.
void expect_same_means(bool leaf) {
  IndirectComparison comparison({}, leaf);
  comparison.run(0, 48);
  glm::dvec3 by_shader(0.0), by_host(0.0);
  for (std::uint32_t frame = 48; frame < 64; ++frame) {
    comparison.run(frame, frame + 1);
    const Sums shader = sums(comparison.shader()), host = sums(comparison.host());
    EXPECT_GT(host.sampled, 0.99);
    EXPECT_GT(shader.sampled, 0.99);
    by_shader += shader.light;
    by_host += host.light;
  }
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(by_host[c] / by_shader[c], 1.0, 0.02) << c;
}

TEST_F(IndirectKernel, GathersTheLightThatShadersGather) {
  expect_same_means(false);
}

// On both sides of the leaf, and what others get of it.
TEST_F(IndirectKernel, GathersTheLightOfBothSides) {
  IndirectComparison comparison({}, true);
  comparison.run(0, 1);
  const ErrorStatistics error = compare(comparison.shader(), comparison.host());
  EXPECT_LT(error.mean, 2e-3);
  EXPECT_LT(error.outliers, 6e-3);
  expect_same_means(true);
}

TEST_F(IndirectKernel, GathersNothingWithoutLight) {
  protocol::Settings settings;
  settings.lighting.direct = settings.lighting.environment_diffuse = false;
  settings.lighting.emissive = false;
  IndirectComparison comparison(settings);
  comparison.run(0, 4);
  EXPECT_EQ(glm::length(sums(comparison.host()).light), 0.0);
  EXPECT_EQ(glm::length(sums(comparison.shader()).light), 0.0);
}

}  // namespace
}  // namespace heliograph::test
