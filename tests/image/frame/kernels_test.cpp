#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/image/support/renderer_rig.hpp"

namespace heliograph::test {
namespace {

scene::Environment sky() {
  return make_environment(
      64, [](const glm::vec3& d) { return glm::vec3(0.4f + 0.3f * d.x, 0.6f, 0.9f + 0.5f * d.y); });
}

/// Spheres on a glossy floor, with a sun and a point light.
std::shared_ptr<const scene::Scene> small_room() {
  SceneBuilder scene;
  const auto floor = scene.add_quad({glm::vec3(-3, 0, 3), {3, 0, 3}, {3, 0, -3}, {-3, 0, -3}},
                                    surface({0.6f, 0.5f, 0.4f}, 0.25f));
  const auto metal = scene.add_sphere(0.6f, surface({0.9f, 0.8f, 0.6f}, 0.1f, 1.0f));
  const auto plaster = scene.add_sphere(0.5f, surface({0.8f, 0.3f, 0.2f}, 0.8f));
  scene.place(floor);
  scene.place(metal, glm::translate(glm::mat4(1.0f), {-0.8f, 0.6f, 0.0f}));
  scene.place(plaster, glm::translate(glm::mat4(1.0f), {0.7f, 0.5f, 0.4f}));
  scene.add_sun({-0.4f, -1.0f, -0.3f}, {3, 3, 2.7f}, 2.0f)
      .add_point_light({0.5f, 2, 1}, {2, 2, 4}, 0.1f);
  return scene.build();
}

render::Frame moved_view(render::Engine& engine) {
  render::Renderer renderer(engine);
  renderer.set_scene(engine.upload(small_room(), sky()));
  renderer.set_size(240, 136);
  // Shaders make the radiance cache's cells in any order.
  protocol::Settings settings;
  settings.indirect.enabled = false;
  EXPECT_TRUE(renderer.set_settings(settings));
  render::Frame frame;
  for (int i = 0; i < 7; ++i) {
    renderer.set_camera(look({0.03f * static_cast<float>(i), 1.2f, 3.0f}, {0, 0.4f, 0}));
    frame = renderer.render();
  }
  return frame;
}

TEST(HostKernels, ImageMatchesShaders) {
  if (!device().is_cpu()) GTEST_SKIP() << "host kernels run on CPU devices only";
  render::Engine shaders({.validation = true, .host_kernels = false});
  const render::Frame expected = moved_view(shaders), found = moved_view(engine());
  ASSERT_EQ(expected.rgba.size(), found.rgba.size());
  double sum = 0.0, brightness = 0.0;
  std::size_t outliers = 0;
  for (std::size_t i = 0; i < found.rgba.size(); ++i) {
    const int off = std::abs(static_cast<int>(expected.rgba[i]) - static_cast<int>(found.rgba[i]));
    sum += off;
    outliers += off > 4;
    brightness += found.rgba[i];
  }
  const auto count = static_cast<double>(found.rgba.size());
  EXPECT_LT(sum / count, 0.1) << "code values";
  EXPECT_LT(static_cast<double>(outliers) / count, 0.003)
      << "more differences than rounding explains";
  EXPECT_GT(brightness / count, 60.0) << "image is nearly black";
  const auto on_host = [](const render::Frame& frame) {
    return std::count_if(frame.passes.begin(), frame.passes.end(), [](const auto& pass) {
      return pass.kind == protocol::PassKind::host && !pass.name.ends_with(".trace");
    });
  };
  EXPECT_EQ(on_host(expected), 0);
  EXPECT_GT(on_host(found), 20);
}

}  // namespace
}  // namespace heliograph::test
