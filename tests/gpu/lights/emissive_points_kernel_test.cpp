#include <gtest/gtest.h>

#include "render/passes/gbuffer/trace_gbuffer.hpp"
#include "render/passes/indirect/trace_indirect.hpp"
#include "tests/gpu/support/kernel_comparison.hpp"

namespace heliograph::test {
namespace {

/// A sphere between three walls, of which one shines, below a square that shines on both sides.
/// `screen`: and a screen before them that lets light through.
std::shared_ptr<const scene::Scene> glowing_corner(bool screen) {
  SceneBuilder builder;
  if (screen) {
    const auto paper = builder.with_layers(
        surface({0.9f, 0.8f, 0.7f}, 0.9f),
        {.diffuse_transmission = 0.6f, .diffuse_transmission_color = {0.9f, 0.6f, 0.3f}});
    builder.place(builder.add_quad({{{0, -1, 2}, {2, -1, 2}, {2, 1.5f, 2}, {0, 1.5f, 2}}}, paper));
  }
  builder.place(builder.add_quad({{{-3, -1, 3}, {3, -1, 3}, {3, -1, -3}, {-3, -1, -3}}},
                                 surface({0.8f, 0.7f, 0.6f})));
  shared::Material wall = surface({0.9f, 0.2f, 0.1f}, 0.5f);
  wall.emissive = {0.2f, 0.1f, 0.4f};
  builder.place(builder.add_quad({{{-3, -1, -3}, {3, -1, -3}, {3, 3, -3}, {-3, 3, -3}}}, wall));
  builder.place(builder.add_quad({{{-3, -1, 3}, {-3, -1, -3}, {-3, 3, -3}, {-3, 3, 3}}},
                                 surface({0.2f, 0.3f, 0.9f}, 0.4f, 0.8f)));
  shared::Material square = surface(glm::vec3(0.5f));
  square.emissive = {6, 5, 4};
  square.flags = shared::material_double_sided;
  builder.place(
      builder.add_quad({{{0, 2, 0.5f}, {0.5f, 2, 0.5f}, {0.5f, 2, 0}, {0, 2, 0}}}, square));
  builder.place(builder.add_sphere(0.8f, surface({0.5f, 0.5f, 0.5f}, 0.7f)));
  builder.add_point_light({1, 2, 1}, {0.2f, 0.3f, 0.4f}, 0.1f);
  return builder.build();
}

scene::Camera toward_corner() {
  return look({3, 1.5f, 4}, {-0.5f, 0, -0.5f}, 50.0f);
}

class EmissivePointsKernel : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_host_kernels()) GTEST_SKIP() << "host kernels run on CPU devices only";
  }
};

// In the first frame no cell is known: what there is comes from shadow rays and the environment.
// Later shaders make cells in another order, and only means agree.
void expect_light_as_by_shaders(bool screen) {
  FrameRig rig(glowing_corner(screen), toward_corner(), {.extent = {96, 64}});
  const render::GBuffer gbuffer = render::trace_gbuffer(rig.plan(), with_host_kernels(rig, true));
  const auto trace = [&](bool host) {
    const render::FrameInputs& in = with_host_kernels(rig, host);
    const render::RadianceCache cache = render::update_radiance_cache(rig.plan(), in);
    return render::trace_indirect(rig.plan(), in, gbuffer, cache, {});
  };
  const gpu::ImageRef shader = trace(false), host = trace(true);
  rig.invalidate_history();
  const auto run = [&](std::uint32_t frame) {
    rig.set_view(toward_corner(), frame);
    rig.run();
  };
  run(0);
  const ErrorStatistics first = compare(rig.read(shader), rig.read(host));
  EXPECT_LT(first.mean, 2e-3);
  EXPECT_LT(first.outliers, 6e-3);
  for (std::uint32_t frame = 1; frame < 48; ++frame) run(frame);
  glm::dvec3 by_shader(0.0), by_host(0.0);
  const auto add = [&](const render::FloatImage& image, glm::dvec3& sum) {
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
      for (int c = 0; c < 3; ++c) sum[c] += image.rgba[i + std::size_t(c)];
    }
  };
  for (std::uint32_t frame = 48; frame < 64; ++frame) {
    run(frame);
    add(rig.read(shader), by_shader);
    add(rig.read(host), by_host);
  }
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(by_host[c] / by_shader[c], 1.0, 0.02) << c;
}

TEST_F(EmissivePointsKernel, LightsPixelsAndCellsAsShadersDo) {
  expect_light_as_by_shaders(false);
}

TEST_F(EmissivePointsKernel, ShinesThroughAScreenAsShadersDo) {
  expect_light_as_by_shaders(true);
}

}  // namespace
}  // namespace heliograph::test
