#pragma once

#include <glm/glm.hpp>

/// Reference implementation of shaders/lib/lighting/brdf.glsl in double, from the definitions.
namespace heliograph::test {

/// Scale and bias of F0 in the specular albedo (Karis 2013), by the midpoint rule over microfacet
/// normals.
glm::dvec2 split_sum_reference(double n_dot_v, double roughness);

/// BRDF x cos for a gray surface with normal +z.
double shade_light_reference(double base_color, double metallic, double roughness,
                             const glm::dvec3& view, const glm::dvec3& light);

/// G2 / (4 n.l n.v) from Lambda (Heitz 2014, eq. 72 and 99).
double smith_visibility_reference(double n_dot_l, double n_dot_v, double alpha);

}  // namespace heliograph::test
