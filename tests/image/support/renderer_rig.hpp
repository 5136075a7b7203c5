#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "scene/camera/camera.hpp"
#include "tests/support/engine.hpp"
#include "tests/support/image_comparison.hpp"
#include "tests/support/scene_builder.hpp"
#include "tests/support/scene_files.hpp"
#include "tests/support/similarity.hpp"

namespace heliograph::test {

/// A renderer with a scene and a camera, as a session uses it.
class RendererRig {
 public:
  RendererRig(std::shared_ptr<const scene::Scene> scene, const scene::Environment& environment,
              const scene::Camera& camera, std::uint32_t width, std::uint32_t height,
              const std::string& tracer = "auto")
      : renderer(engine(tracer)) {
    renderer.set_scene(engine(tracer).upload(std::move(scene), environment));
    renderer.set_camera(camera);
    renderer.set_size(width, height);
    apply({});
  }

  /// The reference takes over on no device unless it is asked for.
  void apply(protocol::Settings settings) {
    if (settings.reference.use == protocol::ReferenceUse::automatic) {
      settings.reference.use = protocol::ReferenceUse::off;
    }
    if (!renderer.set_settings(settings)) throw std::runtime_error("settings refused");
  }
  /// Renders until `samples` samples are accumulated.
  render::Frame accumulate(std::uint32_t samples) {
    render::Frame frame;
    do frame = renderer.render();
    while (frame.samples < samples);
    return frame;
  }
  render::FloatImage capture(const char* buffer) { return renderer.capture(buffer).value(); }

  render::Renderer renderer;
};

/// Settings without denoising and antialiasing over time, and without indirect light, which
/// bounces: along the same paths as the path tracer's `same_paths`.
inline protocol::Settings undenoised() {
  protocol::Settings settings;
  settings.shadow_temporal.enabled = settings.shadow_blur.enabled = false;
  settings.specular_temporal.enabled = settings.specular_blur.enabled = false;
  settings.indirect.enabled = false;
  settings.antialiasing.temporal = false;
  settings.accumulation.max_samples = 4096;
  return settings;
}

/// Mean radiance of the image after `samples` samples, which is saved under `name`.
inline glm::dvec3 mean_color(RendererRig& rig, const protocol::Settings& settings,
                             const std::string& name, std::uint32_t samples = 96) {
  rig.apply(settings);
  save_image(name, rig.accumulate(samples));
  const render::FloatImage radiance = rig.capture("accumulated");
  glm::dvec3 sum(0.0);
  for (std::size_t i = 0; i < radiance.rgba.size(); i += 4) {
    for (int c = 0; c < 3; ++c) sum[c] += radiance.rgba[i + static_cast<std::size_t>(c)];
  }
  EXPECT_TRUE(std::isfinite(sum.x + sum.y + sum.z));
  return sum / (static_cast<double>(radiance.rgba.size()) / 4.0);
}

inline glm::vec3 rgb(const render::FloatImage& image, std::uint32_t x, std::uint32_t y) {
  const float* values = &image.rgba[(std::size_t{y} * image.width + x) * 4];
  return {values[0], values[1], values[2]};
}

/// Around the origin; `half`: its half extents. The first side is the one toward +Z.
inline std::array<std::array<glm::vec3, 4>, 6> box_sides(const glm::vec3& half) {
  const float x = half.x, y = half.y, z = half.z;
  return {{{{{-x, -y, z}, {x, -y, z}, {x, y, z}, {-x, y, z}}},
           {{{x, -y, -z}, {-x, -y, -z}, {-x, y, -z}, {x, y, -z}}},
           {{{x, -y, z}, {x, -y, -z}, {x, y, -z}, {x, y, z}}},
           {{{-x, -y, -z}, {-x, -y, z}, {-x, y, z}, {-x, y, -z}}},
           {{{-x, y, z}, {x, y, z}, {x, y, -z}, {-x, y, -z}}},
           {{{-x, -y, -z}, {x, -y, -z}, {x, -y, z}, {-x, -y, z}}}}};
}

}  // namespace heliograph::test
