#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace heliograph::scene {

/// An equirectangular environment: linear radiance, row 0 is up.
/// u = 0.5 + atan2(d.z, d.x) / (2 pi), v = acos(d.y) / pi.
struct Environment {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<glm::vec3> radiance;
  bool is_studio = false;  // made by studio_environment()
};

/// Of a file.
inline constexpr std::uint64_t most_environment_bytes = 512ull << 20;

/// Reads a Radiance .hdr or an OpenEXR file of at most 8192 x 4096 pixels. Radiance is from 0 to
/// 1e6.
/// @throws ImportError
Environment load_environment(const std::filesystem::path& path);

/// The same of the bytes of such a file. @throws ImportError
Environment decode_environment(std::span<const std::uint8_t> file);

/// Valid radiance: from 0 to 1e6; NaN becomes 0.
glm::vec3 physical_radiance(const glm::vec3& radiance);

/// Constant radiance from every direction (a furnace).
Environment constant_environment(const glm::vec3& radiance);

}  // namespace heliograph::scene
