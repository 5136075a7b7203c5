#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "scene/environment.hpp"

namespace heliograph::scene {

/// An equirectangular image of a photographer's studio: a grey room with four softboxes (a large
/// key, a long fill, a rim strip, one overhead) that give highlights with crisp, tapered edges. An
/// upward facing surface gets irradiance near pi, so that white comes out near 1.
std::vector<glm::vec3> studio_radiance(int width, int height);

/// The environment of scenes that have none.
Environment studio_environment();

}  // namespace heliograph::scene
