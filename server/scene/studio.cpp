#include "scene/studio.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <iterator>

namespace heliograph::scene {
namespace {

// Brings an upward facing surface to irradiance pi.
constexpr float aperture = 0.403f;

/// A rectangle at distance 1 that looks at the middle of the room.
struct SoftBox {
  float elevation;      // degrees, above the horizon
  float azimuth;        // degrees, from +z toward +x
  glm::vec2 half_size;  // metres at distance 1: tangents of the half angles
  glm::vec3 radiance;
};

constexpr SoftBox boxes[] = {
    {38.0f, 50.0f, {0.55f, 0.42f}, {9.0f, 8.7f, 8.2f}},      // key, warm
    {18.0f, -75.0f, {0.28f, 0.75f}, {3.4f, 3.7f, 4.1f}},     // fill, cool
    {25.0f, 170.0f, {0.75f, 0.10f}, {10.0f, 10.0f, 10.4f}},  // rim strip behind
    {84.0f, 0.0f, {0.50f, 0.50f}, {4.2f, 4.2f, 4.2f}},       // overhead
};

/// A box with its place in the room.
struct PlacedBox {
  explicit PlacedBox(const SoftBox& placed) : box(placed) {
    const float elevation = glm::radians(box.elevation), azimuth = glm::radians(box.azimuth);
    axis = {std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
            std::cos(elevation) * std::cos(azimuth)};
    right = glm::normalize(glm::cross(axis, glm::vec3(0.0f, 1.0f, 0.0f)));
    up = glm::cross(right, axis);
  }

  SoftBox box;
  glm::vec3 axis, right, up;
};

const std::vector<PlacedBox>& placed_boxes() {
  static const std::vector<PlacedBox> placed(std::begin(boxes), std::end(boxes));
  return placed;
}

// Visible fraction of the box in a direction: 1 inside, with a soft edge.
float coverage(const PlacedBox& placed, glm::vec3 direction) {
  const float along = glm::dot(direction, placed.axis);
  if (along <= 0.0f) return 0.0f;
  const glm::vec2 half_size = placed.box.half_size;
  const glm::vec2 at =
      glm::abs(glm::vec2(glm::dot(direction, placed.right), glm::dot(direction, placed.up))) /
      along;
  constexpr float rim = 0.03f;
  const glm::vec2 inside = glm::clamp((half_size - at) / rim, 0.0f, 1.0f);
  // The light source is behind the center of the cloth.
  const glm::vec2 from_middle = at / half_size;
  const float hot = 1.0f - 0.35f * std::min(1.0f, 0.5f * glm::dot(from_middle, from_middle));
  return inside.x * inside.y * hot;
}

// Walls that darken upwards from a light sweep of paper; a floor a little darker than the sweep.
glm::vec3 room(glm::vec3 direction) {
  const float height = direction.y;
  const float wall = glm::mix(0.42f, 0.10f, std::clamp(1.4f * height, 0.0f, 1.0f));
  const float floor = glm::mix(0.42f, 0.24f, std::clamp(-2.0f * height, 0.0f, 1.0f));
  return glm::vec3(0.98f, 0.99f, 1.02f) * (height >= 0.0f ? wall : floor);
}

glm::vec3 radiance_at(float u, float v) {
  const float azimuth = (u - 0.5f) * glm::two_pi<float>(), polar = v * glm::pi<float>();
  const glm::vec3 direction(std::sin(polar) * std::cos(azimuth), std::cos(polar),
                            std::sin(polar) * std::sin(azimuth));
  glm::vec3 radiance = room(direction);
  for (const PlacedBox& placed : placed_boxes()) {
    radiance += placed.box.radiance * coverage(placed, direction);
  }
  return aperture * radiance;
}

}  // namespace

std::vector<glm::vec3> studio_radiance(int width, int height) {
  // Edges of the boxes are averaged over a grid inside each pixel.
  constexpr int grid = 4;
  std::vector<glm::vec3> texels;
  texels.reserve(std::size_t(width) * std::size_t(height));
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      glm::vec3 sum(0.0f);
      for (int k = 0; k < grid * grid; ++k) {
        const float u = (float(x) + (float(k % grid) + 0.5f) / float(grid)) / float(width);
        const float v = (float(y) + (float(k / grid) + 0.5f) / float(grid)) / float(height);
        sum += radiance_at(u, v);
      }
      texels.push_back(sum / float(grid * grid));
    }
  }
  return texels;
}

Environment studio_environment() {
  constexpr std::uint32_t width = 512, height = 256;
  return {width, height, studio_radiance(width, height), true};
}

}  // namespace heliograph::scene
