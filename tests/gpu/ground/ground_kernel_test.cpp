#include <gtest/gtest.h>

#include "render/passes/compose/skybox.hpp"
#include "render/passes/ground/ground.hpp"
#include "tests/gpu/support/kernel_comparison.hpp"

namespace heliograph::test {
namespace {

/// A sphere above the ground, lit from everywhere.
std::shared_ptr<const scene::Scene> lit_sphere() {
  SceneBuilder builder;
  builder.place(builder.add_sphere(0.8f, surface({0.5f, 0.5f, 0.5f}, 0.7f)));
  builder.add_point_light({1.5f, 1.5f, 0.4f}, {3, 4, 5}, 0.1f);
  builder.add_sun({0.4f, -1.0f, 0.2f}, {1.0f, 0.9f, 0.8f});
  return builder.build();
}

const scene::Camera above = look({2, 3, 4}, {0, -0.6f, 0}, 50.0f);

class GroundKernel : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_host_kernels()) GTEST_SKIP() << "host kernels run on CPU devices only";
  }
};

TEST_F(GroundKernel, DarkensTheBackgroundAsShadersDo) {
  for (const bool orthographic : {false, true}) {
    RigOptions options{.extent = {97, 65}};
    options.settings.background.ground = protocol::GroundUse::on;
    scene::Camera camera = above;
    if (orthographic) camera.orthographic_height = 5.0f;
    FrameRig rig(lit_sphere(), camera, options);
    render::GBuffer gbuffer;
    gbuffer.motion = RandomFrame(rig).four("none", glm::vec4(0), glm::vec4(0));
    const auto draw = [&](bool host) {
      const render::FrameInputs& in = with_host_kernels(rig, host);
      const gpu::BufferRef ground = render::trace_ground(rig.plan(), in);
      const gpu::ImageRef background = render::draw_skybox(rig.plan(), in, gbuffer);
      render::shade_ground(rig.plan(), in, gbuffer, ground, background);
      return background;
    };
    const gpu::ImageRef shader = draw(false), host = draw(true);
    rig.invalidate_history();
    for (std::uint32_t frame = 0; frame < 5; ++frame) {
      rig.set_view(camera, frame);
      rig.run();
    }
    const render::FloatImage drawn = rig.read(host);
    const ErrorStatistics result = compare(rig.read(shader), drawn);
    EXPECT_LT(result.mean, 1e-3) << orthographic;
    EXPECT_LT(result.outliers, 2e-3) << orthographic;
    float darkest = 1.0f;
    for (std::size_t i = 0; i < drawn.rgba.size(); i += 4) {
      darkest = std::min(darkest, drawn.rgba[i]);
    }
    EXPECT_LT(darkest, 0.5f) << "no shadow is in view";
  }
}

}  // namespace
}  // namespace heliograph::test
