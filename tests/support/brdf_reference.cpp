#include "tests/support/brdf_reference.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace heliograph::test {
namespace {

constexpr double pi = std::numbers::pi;

double schlick(double f0, double cosine) {
  return f0 + (1.0 - f0) * std::pow(1.0 - cosine, 5.0);
}

}  // namespace

double smith_visibility_reference(double n_dot_l, double n_dot_v, double alpha) {
  const auto lambda = [alpha](double cosine) {
    const double tan2 = (1.0 - cosine * cosine) / (cosine * cosine);
    return 0.5 * (std::sqrt(1.0 + alpha * alpha * tan2) - 1.0);
  };
  return 1.0 / (1.0 + lambda(n_dot_l) + lambda(n_dot_v)) / (4.0 * n_dot_l * n_dot_v);
}

glm::dvec2 split_sum_reference(double n_dot_v, double roughness) {
  constexpr int steps = 256;
  const double alpha = std::max(roughness * roughness, 1e-4);
  const glm::dvec3 view(std::sqrt(1.0 - n_dot_v * n_dot_v), 0.0, n_dot_v);
  glm::dvec2 sum(0.0);
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; j < steps; ++j) {
      const double u = (i + 0.5) / steps, angle = 2.0 * pi * (j + 0.5) / steps;
      const double tan2 = alpha * alpha * u / (1.0 - u);
      const double cosine = 1.0 / std::sqrt(1.0 + tan2);
      const double sine = std::sqrt(tan2) * cosine;
      const glm::dvec3 half(sine * std::cos(angle), sine * std::sin(angle), cosine);
      const double v_dot_h = glm::dot(view, half);
      const glm::dvec3 light = 2.0 * v_dot_h * half - view;
      if (light.z <= 0.0 || v_dot_h <= 0.0) continue;
      const double weight =
          4.0 * smith_visibility_reference(light.z, n_dot_v, alpha) * light.z * v_dot_h / cosine;
      const double grazing = std::pow(1.0 - v_dot_h, 5.0);
      sum += weight * glm::dvec2(1.0 - grazing, grazing);
    }
  }
  return sum / double(steps * steps);
}

double shade_light_reference(double base_color, double metallic, double roughness,
                             const glm::dvec3& view, const glm::dvec3& light) {
  const glm::dvec2 split = split_sum_reference(view.z, roughness);
  const double regained = 1.0 / (split.x + split.y) - 1.0;
  const glm::dvec3 half = glm::normalize(view + light);
  const double alpha = roughness * roughness;
  const double d = half.z * half.z * (alpha * alpha - 1.0) + 1.0;
  const double lobe =
      alpha * alpha / (pi * d * d) * smith_visibility_reference(light.z, view.z, alpha);
  const auto specular = [&](double f0) {
    return lobe * schlick(f0, glm::dot(view, half)) * (1.0 + f0 * regained);
  };
  const double albedo = (0.04 * split.x + split.y) * (1.0 + 0.04 * regained);
  const double dielectric = specular(0.04) + (1.0 - albedo) * base_color / pi;
  const double metal = specular(base_color);
  return ((1.0 - metallic) * dielectric + metallic * metal) * light.z;
}

}  // namespace heliograph::test
