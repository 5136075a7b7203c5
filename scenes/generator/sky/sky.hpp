#pragma once

#include <glm/glm.hpp>

#include "scenes/generator/sky/environment.hpp"

namespace heliograph::scenes {

/// A clear sky and the light of the sun that belongs to it, in the same arbitrary unit.
struct ClearSky {
  Environment environment;   // without the disc of the sun
  glm::vec3 sun_irradiance;  // of a surface that faces the sun, at the ground
  glm::vec3 sky_irradiance;  // of an upward facing surface, by the sky alone
};

/// Integrates sunlight scattered by air, haze and absorbed by ozone through a spherical
/// atmosphere (Nishita et al. 1993), with the higher orders of scattering as in Hillaire 2020,
/// eq. 5-10. `to_sun` is a unit vector with y > 0.
ClearSky make_clear_sky(glm::vec3 to_sun, int width, int height);

}  // namespace heliograph::scenes
