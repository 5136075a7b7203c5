#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <vector>

namespace heliograph::scene {

/// An equirectangular environment: linear radiance, row 0 is up.
/// u = 0.5 + atan2(d.z, d.x) / (2 pi), v = acos(d.y) / pi.
struct Environment {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<glm::vec3> radiance;
};

/// Reads a Radiance .hdr or an OpenEXR file of at most 8192 x 4096 pixels. Radiance is from 0 to
/// 1e6.
/// @throws ImportError
Environment load_environment(const std::filesystem::path& path);

/// Constant radiance from every direction (a furnace).
Environment constant_environment(const glm::vec3& radiance);

}  // namespace heliograph::scene
