#include "scenes/generator/sky/studio.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "scenes/generator/gltf/document.hpp"

namespace heliograph::scenes {
namespace {

// Brings an upward facing surface to irradiance pi.
constexpr float aperture = 0.403f;

/// A rectangle at distance 1 that looks at the middle of the room.
struct SoftBox {
  float elevation;  // degrees, as direction_to_sun
  float azimuth;
  glm::vec2 half_size;  // metres at distance 1: tangents of the half angles
  glm::vec3 radiance;
};

constexpr SoftBox boxes[] = {
    {38.0f, 50.0f, {0.55f, 0.42f}, {9.0f, 8.7f, 8.2f}},      // key, warm
    {18.0f, -75.0f, {0.28f, 0.75f}, {3.4f, 3.7f, 4.1f}},     // fill, cool
    {25.0f, 170.0f, {0.75f, 0.10f}, {10.0f, 10.0f, 10.4f}},  // rim strip behind
    {84.0f, 0.0f, {0.50f, 0.50f}, {4.2f, 4.2f, 4.2f}},       // overhead
};

// Visible fraction of the box in a direction: 1 inside, with a soft edge.
float coverage(const SoftBox& box, glm::vec3 direction) {
  const glm::vec3 axis = direction_to_sun(box.elevation, box.azimuth);
  const float along = glm::dot(direction, axis);
  if (along <= 0.0f) return 0.0f;
  const glm::vec3 right = glm::normalize(glm::cross(axis, glm::vec3(0.0f, 1.0f, 0.0f)));
  const glm::vec3 up = glm::cross(right, axis);
  const glm::vec2 at =
      glm::abs(glm::vec2(glm::dot(direction, right), glm::dot(direction, up))) / along;
  constexpr float rim = 0.03f;
  const glm::vec2 inside = glm::clamp((box.half_size - at) / rim, 0.0f, 1.0f);
  // The light source is behind the center of the cloth.
  const glm::vec2 from_middle = at / box.half_size;
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

}  // namespace

Environment make_studio(int width, int height) {
  Environment studio(width, height);
  // Edges of the boxes are averaged over a grid inside each pixel.
  constexpr int grid = 4;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      glm::vec3 sum(0.0f);
      for (int k = 0; k < grid * grid; ++k) {
        const float u = (float(x) + (float(k % grid) + 0.5f) / float(grid)) / float(width);
        const float v = (float(y) + (float(k / grid) + 0.5f) / float(grid)) / float(height);
        const float azimuth = (u - 0.5f) * glm::two_pi<float>();
        const float polar = v * glm::pi<float>();
        const glm::vec3 direction(std::sin(polar) * std::cos(azimuth), std::cos(polar),
                                  std::sin(polar) * std::sin(azimuth));
        glm::vec3 radiance = room(direction);
        for (const SoftBox& box : boxes) radiance += box.radiance * coverage(box, direction);
        sum += radiance;
      }
      studio.at(x, y) = sum * (aperture / float(grid * grid));
    }
  }
  return studio;
}

}  // namespace heliograph::scenes
