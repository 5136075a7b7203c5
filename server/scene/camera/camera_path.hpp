#pragma once

#include <span>

#include "scene/scene.hpp"

namespace heliograph::scene {

struct PathForm {
  bool smooth = true;   // a spline through the keys that begins and ends slowly
  bool closed = false;  // leads back to the first key
};

/// The camera at a fraction of its path, 0..1. Keys stand at equal distances of time. The target
/// goes along a line or a Catmull-Rom spline; the camera turns about it, at a distance that changes
/// by factors. Of `keys`, at least one, only perspective ones move by their field of view.
Camera camera_on_path(std::span<const Camera> keys, const PathForm& form, float fraction);

}  // namespace heliograph::scene
