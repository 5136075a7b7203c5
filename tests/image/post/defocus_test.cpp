#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "tests/image/support/renderer_rig.hpp"

namespace heliograph::test {
namespace {

using protocol::ReferenceUse;

constexpr std::uint32_t lens_width = 240, lens_height = 136;

/// A bright wall on the right half of what is seen, `distance` in front of the camera, before
/// nothing.
std::shared_ptr<const scene::Scene> bright_wall(float distance) {
  SceneBuilder builder;
  shared::Material shining = surface({0, 0, 0});
  shining.emissive = glm::vec3(1.0f);
  const float z = -distance, far = 4.0f * distance;
  builder.place(
      builder.add_quad({{{0, -far, z}, {far, -far, z}, {far, far, z}, {0, far, z}}}, shining));
  return builder.build();
}

scene::Camera ahead() {
  return look({0, 0, 0}, {0, 0, -4});
}

/// A lens of such an aperture that a wall at 2 m is blurred by `radius` pixels, in focus at 4 m.
protocol::Settings lens_settings(float radius) {
  protocol::Settings settings = undenoised();
  settings.lens.depth_of_field = true;
  settings.lens.focus_distance = 4.0f;
  const float slope = std::tan(glm::radians(22.5f));
  const float pixel = 2.0f * slope / lens_height;  // at a metre, metres
  const float aperture = radius * pixel / (1.0f / 2.0f - 1.0f / 4.0f);
  const float focal_length = 0.012f / slope;
  settings.lens.f_number = 0.5f * focal_length / aperture;
  return settings;
}

/// Luminance along the middle row of the mean of `samples` samples.
std::vector<float> middle_row(RendererRig& rig, const protocol::Settings& settings,
                              const std::string& name, std::uint32_t samples) {
  rig.apply(settings);
  save_image(name, rig.accumulate(samples));
  const render::FloatImage image = rig.capture("accumulated");
  std::vector<float> row;
  for (std::uint32_t x = 0; x < lens_width; ++x) {
    float sum = 0.0f;
    for (std::uint32_t y = lens_height / 2 - 10; y < lens_height / 2 + 10; ++y)
      sum += rgb(image, x, y).y;
    row.push_back(sum / 20.0f);
  }
  return row;
}

/// The part of a disk of radius 1 that lies on one side of a line at this distance.
double part_of_disk(double at) {
  if (at >= 1.0) return 1.0;
  if (at <= -1.0) return 0.0;
  return 0.5 + (at * std::sqrt(1.0 - at * at) + std::asin(at)) / std::numbers::pi;
}

class DepthOfField : public testing::TestWithParam<ReferenceUse> {};

/// The edge of what is out of focus is the integral of the aperture's disk.
TEST_P(DepthOfField, BlursAnEdgeByTheCircleOfConfusion) {
  constexpr float radius = 8.0f;
  RendererRig rig(bright_wall(2.0f), scene::constant_environment(glm::vec3(0.0f)), ahead(),
                  lens_width, lens_height);
  protocol::Settings settings = lens_settings(radius);
  settings.reference.use = GetParam();
  settings.reference.scope = protocol::ReferenceScope::full;
  const std::string name =
      std::string("defocus_edge_") + (GetParam() == ReferenceUse::off ? "hybrid" : "reference");
  const std::vector<float> row = middle_row(rig, settings, name, 256);
  for (int x = -14; x < 14; ++x) {
    const double expected = part_of_disk((x + 0.5) / double{radius});
    EXPECT_NEAR(row[static_cast<std::size_t>(x + int{lens_width} / 2)], expected, 0.04) << x;
  }
}

TEST_P(DepthOfField, LeavesWhatIsInFocusSharp) {
  RendererRig rig(bright_wall(4.0f), scene::constant_environment(glm::vec3(0.0f)), ahead(),
                  lens_width, lens_height);
  protocol::Settings settings = lens_settings(8.0f);
  settings.reference.use = GetParam();
  settings.reference.scope = protocol::ReferenceScope::full;
  const std::vector<float> row = middle_row(rig, settings, "defocus_focus", 32);
  EXPECT_LT(row[lens_width / 2 - 2], 0.02f);
  EXPECT_GT(row[lens_width / 2 + 1], 0.98f);
}

INSTANTIATE_TEST_SUITE_P(HybridAndReference, DepthOfField,
                         testing::Values(ReferenceUse::off, ReferenceUse::always));

/// Spheres in a row that leads away from the camera, over a floor.
std::shared_ptr<const scene::Scene> row_of_spheres() {
  SceneBuilder builder;
  builder.place(builder.add_quad({{{-9, 0, 3}, {9, 0, 3}, {9, 0, -20}, {-9, 0, -20}}},
                                 surface({0.6f, 0.55f, 0.5f}, 0.7f)));
  const auto sphere = builder.add_sphere(0.5f, surface({0.8f, 0.25f, 0.15f}, 0.5f));
  for (int i = 0; i < 5; ++i) {
    const auto number = static_cast<float>(i);
    builder.place(sphere, glm::translate(glm::mat4(1.0f),
                                         {-1.2f + 0.9f * number, 0.5f, 1.5f - 2.2f * number}));
  }
  builder.add_sun({-0.4f, -1.0f, -0.3f}, {2.5f, 2.4f, 2.2f}, 2.0f);
  return builder.build();
}

protocol::Settings portrait() {
  protocol::Settings settings;
  settings.indirect.enabled = false;
  settings.lens.depth_of_field = true;
  settings.lens.focus_distance = 5.0f;
  settings.lens.f_number = 0.2f;
  settings.lens.sensor_height = 200.0f;
  return settings;
}

RendererRig rig_of_spheres() {
  return RendererRig(row_of_spheres(), scene::constant_environment(glm::vec3(0.5f)),
                     look({0, 1.3f, 5}, {0, 0.5f, 0}), lens_width, lens_height);
}

TEST(DepthOfFieldImage, FilteredFrameIsLikeRaysThroughTheLens) {
  RendererRig rig = rig_of_spheres();
  protocol::Settings settings = portrait();
  rig.apply(settings);
  const render::Frame filtered = rig.accumulate(64);
  save_image("defocus_spheres", filtered);
  settings.lens.depth_of_field = false;
  rig.apply(settings);
  const render::Frame sharp = rig.accumulate(64);
  settings.lens.depth_of_field = true;
  settings.reference.use = ReferenceUse::always;
  rig.apply(settings);
  const render::Frame truth = rig.accumulate(256);
  save_image("defocus_spheres_reference", truth);
  const double blurred = ssim(truth, filtered), unblurred = ssim(truth, sharp);
  EXPECT_GT(blurred, 0.97);
  EXPECT_LT(unblurred, 0.93) << "the lens makes no difference";
}

TEST(DepthOfFieldImage, HostKernelsMatchShaders) {
  if (!device().is_cpu()) GTEST_SKIP() << "host kernels run on CPU devices only";
  render::Engine shaders({.validation = true, .host_kernels = false});
  const auto frame_of = [](render::Engine& engine, ReferenceUse use) {
    render::Renderer renderer(engine);
    renderer.set_scene(
        engine.upload(row_of_spheres(), scene::constant_environment(glm::vec3(0.5f))));
    renderer.set_size(lens_width, lens_height);
    renderer.set_camera(look({0, 1.3f, 5}, {0, 0.5f, 0}));
    protocol::Settings settings = portrait();
    settings.reference.use = use;
    EXPECT_TRUE(renderer.set_settings(settings));
    render::Frame frame;
    for (int i = 0; i < 8; ++i) frame = renderer.render();
    return frame;
  };
  for (const ReferenceUse use : {ReferenceUse::off, ReferenceUse::always}) {
    EXPECT_GT(ssim(frame_of(shaders, use), frame_of(engine(), use)), 0.99) << static_cast<int>(use);
  }
}

TEST(DepthOfFieldImage, OrthographicCamerasHaveNoLens) {
  RendererRig rig = rig_of_spheres();
  scene::Camera camera = look({0, 1.3f, 5}, {0, 0.5f, 0});
  camera.orthographic_height = 3.0f;
  rig.renderer.set_camera(camera);
  protocol::Settings settings = portrait();
  rig.apply(settings);
  const render::Frame with = rig.accumulate(4);
  settings.lens.depth_of_field = false;
  rig.apply(settings);
  EXPECT_GT(ssim(with, rig.accumulate(4)), 0.995);
}

}  // namespace
}  // namespace heliograph::test
