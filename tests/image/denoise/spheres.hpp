#pragma once

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/image/support/renderer_rig.hpp"

// The scene, settings and ground truth that the denoiser's tests share.
namespace heliograph::test {

inline constexpr std::uint32_t spheres_width = 160, spheres_height = 90;

/// A rough and a nearly smooth metal sphere on a glossy floor, with soft shadows.
inline std::shared_ptr<const scene::Scene> spheres_on_floor() {
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

/// A sky with one bright side: rotating it moves a light.
inline glm::vec3 one_sided_sky(const glm::vec3& d) {
  return glm::vec3(0.4f, 0.5f, 0.7f) + (d.x > 0.8f ? glm::vec3(4.0f, 3.0f, 2.0f) : glm::vec3(0.0f));
}

inline scene::Camera spheres_camera() {
  return look({0.5f, 2, 4.5f}, {0, 0.5f, 0});
}

/// Shows the denoised frame without accumulation or antialiasing.
inline protocol::Settings denoised_only() {
  protocol::Settings settings;
  settings.indirect.enabled = false;
  settings.antialiasing.jitter = settings.antialiasing.temporal = false;
  settings.accumulation.by_noise = false;
  settings.accumulation.blend_samples = 4096;
  settings.accumulation.max_samples = 4096;
  return settings;
}

inline protocol::Settings noisy_only() {
  protocol::Settings settings = denoised_only();
  settings.shadow_temporal.enabled = settings.shadow_blur.enabled = false;
  settings.specular_temporal.enabled = settings.specular_blur.enabled = false;
  settings.accumulation.blend_samples = 0;
  settings.sampling.seed = 5;
  return settings;
}

class SpheresRig : public RendererRig {
 public:
  explicit SpheresRig(const protocol::Settings& settings)
      : SpheresRig(spheres_on_floor(), settings) {}
  SpheresRig(std::shared_ptr<const scene::Scene> scene, const protocol::Settings& settings)
      : RendererRig(std::move(scene), make_environment(64, one_sided_sky), spheres_camera(),
                    spheres_width, spheres_height) {
    apply(settings);
  }
};

inline render::Frame ground_truth_from(const scene::Camera& camera, float rotation = 0.0f) {
  protocol::Settings settings = noisy_only();
  settings.environment.rotation = rotation;
  SpheresRig rig(settings);
  rig.renderer.set_camera(camera);
  return rig.accumulate(192);
}

}  // namespace heliograph::test
