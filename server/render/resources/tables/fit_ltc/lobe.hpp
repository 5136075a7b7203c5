#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

namespace heliograph::ltc {

constexpr double pi = std::numbers::pi;

/// The specular lobe of shaders/lib/lighting/brdf.glsl without Fresnel, x cos, as a function of
/// where light comes from; the normal is +z.
class SpecularLobe {
 public:
  SpecularLobe(const glm::dvec3& view, double alpha) : view_(view), alpha_(alpha) {}

  double operator()(const glm::dvec3& light) const {
    if (light.z <= 0.0) return 0.0;
    const glm::dvec3 half = glm::normalize(view_ + light);
    const double a2 = alpha_ * alpha_;
    const double d = (1.0 - half.z) * (1.0 + half.z) + half.z * half.z * a2;
    const double distribution = a2 / (pi * d * d);
    const double masked = light.z * std::sqrt(view_.z * view_.z * (1.0 - a2) + a2) +
                          view_.z * std::sqrt(light.z * light.z * (1.0 - a2) + a2);
    return distribution * 0.5 / masked * light.z;
  }

  /// A reflected direction; its half vector is distributed like D cos. May lie below the horizon.
  glm::dvec3 sample(double u, double v) const {
    const double cosine = std::sqrt((1.0 - u) / (1.0 + (alpha_ * alpha_ - 1.0) * u));
    const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    const glm::dvec3 half(sine * std::cos(2.0 * pi * v), sine * std::sin(2.0 * pi * v), cosine);
    return 2.0 * glm::dot(view_, half) * half - view_;
  }

  /// Density of sample() over solid angle.
  double density(const glm::dvec3& light) const {
    const glm::dvec3 half = glm::normalize(view_ + light);
    const double a2 = alpha_ * alpha_;
    const double d = (1.0 - half.z) * (1.0 + half.z) + half.z * half.z * a2;
    return a2 / (pi * d * d) * std::abs(half.z) / (4.0 * std::abs(glm::dot(view_, half)));
  }

 private:
  glm::dvec3 view_;
  double alpha_;
};

/// A linearly transformed cosine (Heitz et al. 2016): the clamped cosine about +z, its directions
/// moved by a matrix. Its integral over all directions is 1.
class TransformedCosine {
 public:
  explicit TransformedCosine(const glm::dmat3& matrix)
      : matrix_(matrix),
        inverse_(glm::inverse(matrix)),
        scale_(std::abs(glm::determinant(inverse_))) {}

  double operator()(const glm::dvec3& direction) const {
    const glm::dvec3 before = inverse_ * direction;
    const double length = glm::length(before);
    const double cosine = std::max(before.z / length, 0.0);
    return cosine / pi * scale_ / (length * length * length);
  }

  glm::dvec3 sample(double u, double v) const {
    const double radius = std::sqrt(u);
    return glm::normalize(matrix_ * glm::dvec3(radius * std::cos(2.0 * pi * v),
                                               radius * std::sin(2.0 * pi * v),
                                               std::sqrt(1.0 - u)));
  }

  /// Its fraction above the horizon: before the matrix, the cosine over the lune between two
  /// hemispheres.
  double share_above() const {
    const glm::dvec3 up(matrix_[0].z, matrix_[1].z, matrix_[2].z);
    return 0.5 * (1.0 + up.z / glm::length(up));
  }

  const glm::dmat3& inverse() const { return inverse_; }

 private:
  glm::dmat3 matrix_;
  glm::dmat3 inverse_;
  double scale_;
};

}  // namespace heliograph::ltc
