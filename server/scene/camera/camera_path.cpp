#include "scene/camera/camera_path.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace heliograph::scene {
namespace {

/// Weights of the keys before, at, after, and after that of a place between two.
using Weights = std::array<float, 4>;

/// Catmull and Rom (1974), with a tension of one half.
Weights spline_weights(float t) {
  const float t2 = t * t, t3 = t2 * t;
  return {0.5f * (-t3 + 2.0f * t2 - t), 0.5f * (3.0f * t3 - 5.0f * t2 + 2.0f),
          0.5f * (-3.0f * t3 + 4.0f * t2 + t), 0.5f * (t3 - t2)};
}

float eased(float t) {
  return t * t * (3.0f - 2.0f * t);
}

/// The keys around a place, and their weights.
struct Neighbours {
  std::array<const Camera*, 4> keys;
  Weights weights;

  template <class Property>
  auto mixed(const Property& property) const {
    auto sum = weights[0] * property(*keys[0]);
    for (std::size_t i = 1; i < 4; ++i) sum += weights[i] * property(*keys[i]);
    return sum;
  }
};

Neighbours neighbours_at(std::span<const Camera> keys, const PathForm& form, float fraction) {
  const auto count = static_cast<std::ptrdiff_t>(keys.size());
  const std::ptrdiff_t segments = form.closed ? count : count - 1;
  float at = std::clamp(fraction, 0.0f, 1.0f);
  if (form.smooth && !form.closed) at = eased(at);
  at *= static_cast<float>(segments);
  const std::ptrdiff_t first =
      std::clamp(static_cast<std::ptrdiff_t>(at), std::ptrdiff_t{0}, segments - 1);
  const float t = at - static_cast<float>(first);
  Neighbours found{{}, form.smooth ? spline_weights(t) : Weights{0.0f, 1.0f - t, t, 0.0f}};
  for (std::ptrdiff_t i = 0; i < 4; ++i) {
    const std::ptrdiff_t key = first - 1 + i;
    const std::ptrdiff_t known =
        form.closed ? (key + count) % count : std::clamp(key, std::ptrdiff_t{0}, count - 1);
    found.keys[static_cast<std::size_t>(i)] = &keys[static_cast<std::size_t>(known)];
  }
  return found;
}

glm::vec3 outward(const Camera& camera) {
  return glm::normalize(camera.eye - camera.target);
}

/// Where opposite directions meet, the camera goes around the side.
glm::vec3 direction_between(const Neighbours& at) {
  const glm::vec3 mixed = at.mixed(outward);
  if (glm::length(mixed) > 1e-3f) return glm::normalize(mixed);
  const glm::vec3 side = glm::cross(at.keys[1]->up, outward(*at.keys[1]));
  return glm::length(side) > 0.0f ? glm::normalize(side) : glm::vec3(1.0f, 0.0f, 0.0f);
}

}  // namespace

Camera camera_on_path(std::span<const Camera> keys, const PathForm& form, float fraction) {
  Camera camera = keys.front();
  if (keys.size() < 2) return camera;
  const Neighbours at = neighbours_at(keys, form, fraction);
  const float distance = std::exp(
      at.mixed([](const Camera& key) { return std::log(glm::distance(key.eye, key.target)); }));
  camera.target = at.mixed([](const Camera& key) { return key.target; });
  camera.eye = camera.target + distance * direction_between(at);
  const glm::vec3 up = at.mixed([](const Camera& key) { return glm::normalize(key.up); });
  camera.up = glm::length(up) > 1e-3f ? glm::normalize(up) : at.keys[1]->up;
  const float field_of_view = at.mixed([](const Camera& key) { return key.vertical_fov; });
  camera.vertical_fov = std::clamp(field_of_view, 1.0f, 170.0f);
  return camera;
}

}  // namespace heliograph::scene
