#pragma once

#include <array>
#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <memory>
#include <stop_token>
#include <vector>

#include "scene/environment.hpp"

namespace heliograph::scene {

/// A square face of a cube as its file has it: RGBD, 8 bits a component, top row first. The colors
/// are sRGB encoded; linear, divided by the last component, they are radiance. Opaque images are
/// thus radiance from 0 to 1.
struct CubeFace {
  std::uint32_t size = 0;
  std::vector<std::uint8_t> rgbd;
};

/// +X, -X, +Y, -Y, +Z, -Z as in EXT_lights_image_based; null: black.
using CubeFaces = std::array<std::shared_ptr<const CubeFace>, 6>;

/// The same light as an equirectangular environment, four times as wide as the largest face within
/// the limit on environments. Every direction of the cube is turned by `rotation`, of unit length,
/// and its radiance multiplied by `intensity`. Computed in parallel.
/// @throws LoadCancelled
Environment environment_of_cube(const CubeFaces& faces, const glm::quat& rotation, float intensity,
                                const std::stop_token& stop);

/// The width of that environment, which is half as high.
std::uint32_t environment_width(const CubeFaces& faces);

}  // namespace heliograph::scene
