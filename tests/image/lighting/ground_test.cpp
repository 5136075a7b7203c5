#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/studio.hpp"
#include "tests/image/support/renderer_rig.hpp"

namespace heliograph::test {
namespace {

constexpr std::uint32_t ground_width = 48, ground_height = 32;
constexpr float white_radiance = 1.0f;

std::shared_ptr<const scene::Scene> sphere_on_ground(bool lit = false) {
  SceneBuilder builder;
  builder.place(builder.add_sphere(1.0f, surface({0.6f, 0.6f, 0.6f}, 0.8f)),
                glm::translate(glm::mat4(1.0f), glm::vec3(0, 1, 0)));
  if (lit) builder.add_sun({0.3f, -1.0f, 0.2f}, {2, 2, 2});
  return builder.build();
}

/// Straight down at the ground `away` metres from where the sphere stands.
scene::Camera over_ground(float away) {
  scene::Camera camera = look({away, 6, 0}, {away, 0, 0}, 10.0f);
  camera.up = {0, 0, -1};
  return camera;
}

protocol::Settings over_white(protocol::GroundUse use) {
  protocol::Settings settings = undenoised();
  settings.background.show = protocol::BackgroundKind::color;
  settings.background.color = {0xffffff};
  settings.background.ground = use;
  return settings;
}

/// Mean radiance in the middle of the image.
float middle(RendererRig& rig, const protocol::Settings& settings, std::uint32_t samples) {
  rig.apply(settings);
  rig.accumulate(samples);
  const render::FloatImage image = rig.capture("accumulated");
  float sum = 0.0f;
  for (std::uint32_t y = ground_height / 2 - 2; y < ground_height / 2 + 2; ++y) {
    for (std::uint32_t x = ground_width / 2 - 2; x < ground_width / 2 + 2; ++x) {
      sum += rgb(image, x, y).y;
    }
  }
  return sum / 16.0f;
}

// Under even light a sphere of radius 1 that lies on the ground takes cos / d^2 of the light, where
// d is the distance to its middle and cos the cosine to it.
TEST(Ground, ShadowOfASphereUnderEvenLightIsItsFormFactor) {
  for (const float away : {1.3f, 1.8f}) {
    RendererRig rig(sphere_on_ground(), scene::constant_environment(glm::vec3(0.7f)),
                    over_ground(away), ground_width, ground_height);
    const float distance = std::sqrt(1.0f + away * away);
    const float expected = white_radiance - 1.0f / (distance * distance * distance);
    EXPECT_NEAR(middle(rig, over_white(protocol::GroundUse::on), 64), expected, 0.03f) << away;
    EXPECT_EQ(middle(rig, over_white(protocol::GroundUse::off), 2), white_radiance) << away;
  }
}

TEST(Ground, ReferenceShowsTheSameShadow) {
  RendererRig rig(sphere_on_ground(true), scene::constant_environment(glm::vec3(0.7f)),
                  over_ground(1.3f), ground_width, ground_height);
  protocol::Settings settings = over_white(protocol::GroundUse::on);
  const float hybrid = middle(rig, settings, 64);
  EXPECT_LT(hybrid, 0.9f);
  settings.reference.use = protocol::ReferenceUse::always;
  for (const auto scope : {protocol::ReferenceScope::same_paths, protocol::ReferenceScope::full}) {
    settings.reference.scope = scope;
    EXPECT_NEAR(middle(rig, settings, 24), hybrid, 0.02f);
  }
}

TEST(Ground, ComesWithTheStudioAloneUnlessItIsAskedFor) {
  const auto with = [](bool lit, const scene::Environment& environment) {
    RendererRig rig(sphere_on_ground(lit), environment, over_ground(1.3f), ground_width,
                    ground_height);
    return middle(rig, over_white(protocol::GroundUse::by_scene), 16);
  };
  EXPECT_LT(with(false, scene::studio_environment()), 0.9f);
  EXPECT_EQ(with(true, scene::studio_environment()), white_radiance);
  EXPECT_EQ(with(false, scene::constant_environment(glm::vec3(0.7f))), white_radiance);
}

TEST(Ground, IsNotSeenFromBelow) {
  scene::Camera below = look({1.3f, -5, 0}, {1.3f, 1, 0}, 10.0f);
  below.up = {0, 0, -1};
  RendererRig rig(sphere_on_ground(), scene::constant_environment(glm::vec3(0.7f)), below,
                  ground_width, ground_height);
  EXPECT_EQ(middle(rig, over_white(protocol::GroundUse::on), 8), white_radiance);
}

TEST(Ground, ShadowStaysWhileTheCameraMoves) {
  RendererRig rig(sphere_on_ground(), scene::constant_environment(glm::vec3(0.7f)),
                  over_ground(1.3f), ground_width, ground_height);
  protocol::Settings settings = over_white(protocol::GroundUse::on);
  const float at_rest = middle(rig, settings, 64);
  rig.renderer.set_camera(over_ground(1.8f));
  rig.renderer.render();
  rig.renderer.set_camera(over_ground(1.3f));
  EXPECT_NEAR(middle(rig, settings, 1), at_rest, 0.02f) << "the first frame after a movement";
}

}  // namespace
}  // namespace heliograph::test
