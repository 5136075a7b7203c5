#pragma once

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/image/support/scene_renderer.hpp"

// What the denoised picture is looked at with.
namespace heliograph::test {

inline constexpr std::uint32_t things_width = 160, things_height = 90;

/// Soft shadows, a matt ball and a nearly smooth metal one, on a ground that mirrors a little.
inline std::shared_ptr<const scene::Scene> things() {
  SceneBuilder builder;
  builder.place(builder.add_quad({{{-9, 0, 9}, {9, 0, 9}, {9, 0, -9}, {-9, 0, -9}}},
                                 surface({0.6f, 0.55f, 0.5f}, 0.4f)));
  builder.place(builder.add_sphere(0.8f, surface({0.8f, 0.2f, 0.1f}, 0.8f)),
                glm::translate(glm::mat4(1.0f), {-0.9f, 0.8f, 0}));
  builder.place(builder.add_sphere(0.6f, surface({0.9f, 0.8f, 0.6f}, 0.15f, 1.0f)),
                glm::translate(glm::mat4(1.0f), {0.8f, 0.6f, 0.5f}));
  builder.add_sun({-0.6f, -1, -0.4f}, glm::vec3(2.5f), 8.0f);
  return builder.build();
}

/// A sky with one bright side, so that turning it is a light that moves.
inline glm::vec3 sky(const glm::vec3& d) {
  return glm::vec3(0.4f, 0.5f, 0.7f) + (d.x > 0.8f ? glm::vec3(4.0f, 3.0f, 2.0f) : glm::vec3(0.0f));
}

inline scene::Camera eye() {
  return look({0.5f, 2, 4.5f}, {0, 0.5f, 0});
}

/// What is shown is the denoised frame alone.
inline protocol::Settings denoised_alone() {
  protocol::Settings settings;
  settings.antialiasing.jitter = settings.antialiasing.temporal = false;
  settings.accumulation.blend_samples = 4096;
  settings.accumulation.max_samples = 4096;
  return settings;
}

inline protocol::Settings raw_alone() {
  protocol::Settings settings = denoised_alone();
  settings.shadow_temporal.enabled = settings.shadow_blur.enabled = false;
  settings.specular_temporal.enabled = settings.specular_blur.enabled = false;
  settings.accumulation.blend_samples = 0;
  settings.sampling.seed = 5;
  return settings;
}

class Things : public Still {
 public:
  explicit Things(const protocol::Settings& settings) : Things(things(), settings) {}
  Things(std::shared_ptr<const scene::Scene> scene, const protocol::Settings& settings)
      : Still(std::move(scene), make_environment(64, sky), eye(), things_width, things_height) {
    apply(settings);
  }
};

inline render::Frame truth_from(const scene::Camera& camera, float rotation = 0.0f) {
  protocol::Settings settings = raw_alone();
  settings.environment.rotation = rotation;
  Things still(settings);
  still.renderer.set_camera(camera);
  return still.accumulate(192);
}

}  // namespace heliograph::test
