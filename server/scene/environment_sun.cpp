#include "scene/environment_sun.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace heliograph::scene {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double max_solid_angle = 0.01;    // a disk of 6.5 degrees
constexpr double min_mean_ratio = 24.0;     // minimum radiance of a sun texel relative to the mean
constexpr double min_peak_fraction = 0.02;  // and relative to the brightest texel
constexpr double min_flux_fraction = 0.01;  // minimum flux of the sun relative to the environment

double luminance_of(const glm::vec3& color) {
  return glm::dot(glm::dvec3(color), glm::dvec3(0.2126, 0.7152, 0.0722));
}

/// Directions and solid angles of the texels of an equirectangular map.
class Sphere {
 public:
  explicit Sphere(const Environment& map)
      : width_(map.width), height_(map.height), step_(pi / map.height) {}

  double solid_angle(std::size_t texel) const {
    const double top = step_ * static_cast<double>(texel / width_);
    return (std::cos(top) - std::cos(top + step_)) * 2.0 * pi / width_;
  }
  glm::dvec3 direction(std::size_t texel) const {
    const double theta = step_ * (static_cast<double>(texel / width_) + 0.5);
    const double phi = ((static_cast<double>(texel % width_) + 0.5) / width_ - 0.5) * 2.0 * pi;
    return {std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)};
  }
  /// Mean squared angular distance of a texel's points from its center, in radians squared.
  double spread(std::size_t texel) const {
    const double theta = step_ * (static_cast<double>(texel / width_) + 0.5);
    const double across = 2.0 * pi / width_ * std::sin(theta);
    return (step_ * step_ + across * across) / 12.0;
  }
  /// Calls `visit` with the adjacent texels, across the seam but not across the poles.
  template <typename Visit>
  void visit_neighbours(std::size_t texel, Visit visit) const {
    const std::size_t x = texel % width_, row = texel - x;
    visit(row + (x + 1) % width_);
    visit(row + (x + width_ - 1) % width_);
    if (texel >= width_) visit(texel - width_);
    if (texel + width_ < std::size_t{width_} * height_) visit(texel + width_);
  }

 private:
  std::uint32_t width_;
  std::uint32_t height_;
  double step_;
};

/// A connected region of bright texels and the mean radiance around it.
struct Region {
  std::vector<std::size_t> texels;
  glm::dvec3 rim{0.0};
  double solid_angle = 0.0;
};

Region grow(const Environment& map, const Sphere& sphere, std::size_t from, double threshold) {
  Region region;
  std::vector<bool> seen(map.radiance.size(), false);
  region.texels.push_back(from);
  seen[from] = true;
  double rim_weight = 0.0;
  for (std::size_t i = 0; i < region.texels.size(); ++i) {
    region.solid_angle += sphere.solid_angle(region.texels[i]);
    if (region.solid_angle > max_solid_angle) break;
    sphere.visit_neighbours(region.texels[i], [&](std::size_t next) {
      if (seen[next]) return;
      seen[next] = true;
      if (luminance_of(map.radiance[next]) > threshold) {
        region.texels.push_back(next);
        return;
      }
      const double weight = sphere.solid_angle(next);
      region.rim += weight * glm::dvec3(map.radiance[next]);
      rim_weight += weight;
    });
  }
  if (rim_weight > 0.0) region.rim /= rim_weight;
  return region;
}

/// Flux of a region above the radiance of its border.
Sun sun_of(const Environment& map, const Sphere& sphere, const Region& region) {
  glm::dvec3 irradiance(0.0), towards(0.0);
  for (const std::size_t texel : region.texels) {
    const glm::dvec3 more = glm::dvec3(map.radiance[texel]) - region.rim;
    irradiance += sphere.solid_angle(texel) * more;
    towards += sphere.solid_angle(texel) * luminance_of(more) * sphere.direction(texel);
  }
  towards = glm::normalize(towards);
  // The mean squared distance of a disk's points from its center is half its squared radius.
  double weight = 0.0, squares = 0.0;
  for (const std::size_t texel : region.texels) {
    const double texel_weight = std::max(
        sphere.solid_angle(texel) * luminance_of(glm::dvec3(map.radiance[texel]) - region.rim),
        0.0);
    const glm::dvec3 aside = glm::cross(towards, sphere.direction(texel));
    weight += texel_weight;
    squares += texel_weight * (glm::dot(aside, aside) + sphere.spread(texel));
  }
  const double radius = std::sqrt(2.0 * squares / weight);
  return {towards, glm::max(irradiance, glm::dvec3(0.0)),
          static_cast<float>(2.0 * radius * 180.0 / pi)};
}

}  // namespace

SeparatedEnvironment separate_sun(Environment environment) {
  const Sphere sphere(environment);
  double flux = 0.0, brightest = 0.0;
  std::size_t peak = 0;
  for (std::size_t i = 0; i < environment.radiance.size(); ++i) {
    const double value = luminance_of(environment.radiance[i]);
    flux += value * sphere.solid_angle(i);
    if (value > brightest) {
      brightest = value;
      peak = i;
    }
  }
  const double threshold =
      std::max(min_mean_ratio * flux / (4.0 * pi), min_peak_fraction * brightest);
  if (brightest <= threshold) return {std::move(environment), std::nullopt};
  const Region region = grow(environment, sphere, peak, threshold);
  if (region.solid_angle > max_solid_angle) return {std::move(environment), std::nullopt};
  const Sun sun = sun_of(environment, sphere, region);
  if (luminance_of(sun.irradiance) < min_flux_fraction * flux) {
    return {std::move(environment), std::nullopt};
  }
  for (const std::size_t texel : region.texels) environment.radiance[texel] = region.rim;
  return {std::move(environment), sun};
}

}  // namespace heliograph::scene
