#pragma once

#include <array>
#include <glm/glm.hpp>

#include "scene/environment.hpp"

namespace heliograph::render {

/// Irradiance / pi of an environment in nine spherical harmonics, ready for the polynomial of
/// shaders/lib/lighting/environment.glsl (Ramamoorthi and Hanrahan 2001, eq. 8 to 13). rgb; w is 0.
std::array<glm::vec4, 9> project_irradiance(const scene::Environment& environment);

/// The same polynomial on the host, for tests: irradiance / pi of a surface facing the unit vector
/// `normal`.
glm::vec3 evaluate_irradiance(const std::array<glm::vec4, 9>& coefficients,
                              const glm::vec3& normal);

}  // namespace heliograph::render
