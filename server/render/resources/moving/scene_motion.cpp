#include "render/resources/moving/scene_motion.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>

#include "render/resources/moving/moving_scene.hpp"
#include "shaders/shared/denoise.h"

namespace heliograph::render {
namespace {

constexpr glm::vec3 luminance_weights(0.2126f, 0.7152f, 0.0722f);

struct Sum {
  float moved = 0.0f;
  float light = 0.0f;

  void add(float irradiance, float distance, float width) {
    light += irradiance;
    if (distance > 0.0f) moved += irradiance * std::min(distance / std::max(width, 1e-9f), 1.0f);
  }
};

/// Half the angle between the directions, as its tangent: what radii of directional lights are.
float half_turn(const glm::vec3& before, const glm::vec3& now) {
  const float across = glm::distance(before, now);
  if (across < 1e-6f) return 0.0f;  // rounding
  return across / std::max(glm::length(before + now), 1e-6f);
}

/// From the middle of the scene.
float squared_distance(const shared::Light& light, const scene::Bounds& bounds) {
  const glm::vec3 direction = light.position - bounds.center();
  const float nearest = 0.1f * bounds.radius();
  return std::max({glm::dot(direction, direction), nearest * nearest, 1e-12f});
}

float irradiance(const shared::Light& light, const scene::Bounds& bounds) {
  const float strength = glm::dot(light.color, luminance_weights);
  if (light.type == shared::light_directional) return strength;
  const bool point = light.type == shared::light_point || light.type == shared::light_spot;
  const float area = point ? 1.0f : glm::pi<float>() * light.radius * light.radius;
  return strength * area / squared_distance(light, bounds);
}

void add(Sum& sum, const shared::Light& now, const shared::Light& before,
         const scene::Bounds& bounds, float forced_radius) {
  const float strength = irradiance(now, bounds);
  if (now.type == shared::light_directional) {
    const float radius = forced_radius >= 0.0f ? forced_radius : now.radius;
    sum.add(strength, half_turn(before.direction, now.direction), radius);
  } else {
    const float rotated = now.radius * half_turn(before.direction, now.direction);
    sum.add(strength, glm::distance(before.position, now.position) + rotated, 2.0f * now.radius);
  }
}

}  // namespace

SceneMotion scene_motion(const MovingScene& scene, const shared::FrameConstants& now,
                         const shared::FrameConstants* before) {
  if (!before) return {};
  Sum sum;
  const auto& lights = scene.lights();
  const auto& previous = scene.previous_lights();
  for (std::size_t i = 0; i < lights.size(); ++i) {
    add(sum, lights[i], previous[i], scene.resources().scene->bounds, now.directional_light_radius);
  }
  if (now.sun_radius >= 0.0f && before->sun_radius >= 0.0f) {
    sum.add(glm::dot(now.sun_irradiance, luminance_weights),
            half_turn(before->sun_direction, now.sun_direction), now.sun_radius);
  }
  bool changed = now.environment_intensity != before->environment_intensity ||
                 now.sun_irradiance != before->sun_irradiance || lights.size() != previous.size();
  for (std::size_t i = 0; i < lights.size() && !changed; ++i) {
    changed = lights[i].color != previous[i].color;
  }
  const glm::vec2 facing(now.environment_cos, now.environment_sin);
  const glm::vec2 faced(before->environment_cos, before->environment_sin);
  const float rotation =
      std::atan2(facing.x * faced.y - facing.y * faced.x, glm::dot(facing, faced));
  return {sum.light > 0.0f ? sum.moved / sum.light : 0.0f, std::abs(rotation),
          scene.geometry_moved(), changed};
}

float frames_under_motion(float motion) {
  if (motion <= 0.0f) return std::numeric_limits<float>::max();
  return 1.0f + shared::motion_history_factor *
                    (std::pow(std::min(motion, 1.0f), shared::motion_history_exponent) - 1.0f);
}

}  // namespace heliograph::render
