#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace heliograph::scenes {

/// An equirectangular image of radiance, rows from the zenith down:
/// u = 0.5 + atan2(d.z, d.x) / (2 pi), v = acos(d.y) / pi.
struct Environment {
  int width = 0;
  int height = 0;
  std::vector<glm::vec3> radiance;

  Environment(int width_, int height_)
      : width(width_), height(height_), radiance(std::size_t(width_) * std::size_t(height_)) {}

  glm::vec3& at(int x, int y) { return radiance[std::size_t(y * width + x)]; }
  const glm::vec3& at(int x, int y) const { return radiance[std::size_t(y * width + x)]; }

  /// Direction through the middle of a pixel.
  glm::vec3 direction(int x, int y) const;

  /// Irradiance of an upward facing surface.
  glm::vec3 horizontal_irradiance() const;
};

/// The bytes of a Radiance .hdr file (RGBE, run-length encoded; Ward, "Real Pixels", Graphics
/// Gems II).
std::vector<std::uint8_t> encode_hdr(const Environment& environment);

}  // namespace heliograph::scenes
