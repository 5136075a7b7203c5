#pragma once

#include <glm/glm.hpp>

/// shaders/lib/lighting/brdf.glsl once more, in double and from the definitions.
namespace heliograph::test {

/// Scale and bias of F0 in the specular albedo (Karis 2013), by a midpoint rule over the
/// microfacets' normals.
glm::dvec2 split_sum_twin(double n_dot_v, double roughness);

/// BRDF x cos for a grey surface whose normal is +z.
double shade_light_twin(double base_color, double metallic, double roughness,
                        const glm::dvec3& view, const glm::dvec3& light);

/// G2 / (4 n.l n.v) by way of Lambda (Heitz 2014, eq. 72 and 99).
double smith_visibility_twin(double n_dot_l, double n_dot_v, double alpha);

}  // namespace heliograph::test
