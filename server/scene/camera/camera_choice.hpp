#pragma once

#include <glm/glm.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "scene/scene.hpp"

namespace heliograph::scene {

/// The scene's camera of this name, or else of this number, counted from 1. Null if there is none.
const Camera* find_camera(const Scene& scene, std::string_view name);

/// Free part of an image on each side of what is fitted into it.
inline constexpr float default_margin = 0.04f / 1.08f;

/// How a scene is fitted into an image.
struct Fit {
  float vertical_fov = 45.0f;  // degrees
  float aspect = 1.0f;         // width / height
  float margin = default_margin;
};

/// The unit vector from a scene toward a camera. Degrees: azimuth 0 is in front, +Z, and 90 on the
/// right, +X; elevation 90 is above, +Y.
glm::vec3 orbit_direction(float azimuth, float elevation);

/// Slightly from the right and from above.
glm::vec3 default_direction();

/// Cameras in these directions from the middle of `bounds`, all at the distance from which each
/// sees all of it.
std::vector<Camera> fit_cameras(const Bounds& bounds, std::span<const glm::vec3> directions,
                                const Fit& fit);

}  // namespace heliograph::scene
