#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "scenes/generator/atrium/atrium_parts.hpp"
#include "scenes/generator/atrium/atrium_plan.hpp"
#include "scenes/generator/geometry/shapes.hpp"
#include "scenes/generator/geometry/transforms.hpp"

namespace heliograph::scenes {
namespace {

constexpr float tile_pitch = 0.30f;
const glm::vec2 eaves{-0.62f, 12.98f};  // outwards from the column axes, height
const glm::vec2 ridge{plan::roof_depth, plan::ridge_height};

// One run of convex cover tiles up the slope, each course tucked under the next.
Mesh tile_run(float length, int courses) {
  Mesh mesh;
  const float course = length / float(courses);
  for (int k = 0; k < courses; ++k) {
    const float lift = 0.025f;
    mesh.append(patch(6, 1, [&](float u, float v) {
      const float angle = pi * u;
      const float radius = glm::mix(0.105f, 0.085f, v);
      const glm::vec3 normal(std::cos(angle), std::sin(angle), 0.0f);
      return SurfacePoint{
          {radius * normal.x, radius * normal.y + lift * (1.0f - v), -(float(k) + v) * course},
          normal,
          {angle * radius, -v * course}};
    }));
  }
  // The open end at the eaves, closed with mortar.
  mesh.append(patch(6, 1, [&](float u, float v) {
    const float angle = pi * u;
    const glm::vec3 rim(std::cos(angle) * 0.105f, std::sin(angle) * 0.105f * v + 0.025f, 0.01f);
    return SurfacePoint{rim, {0, 0, 1}, {rim.x, -rim.y}};
  }));
  return mesh;
}

// The slope of one side in its own frame: +Z faces the courtyard, z = 0 on the column axes.
Mesh roof_side(float half_length_at_axis) {
  const glm::vec3 low(0.0f, eaves.y, -eaves.x);
  const glm::vec3 high(0.0f, ridge.y, -ridge.x);
  const glm::vec3 up_slope = glm::normalize(high - low);
  const float slope_length = glm::distance(low, high);
  const float low_half = half_length_at_axis + eaves.x;
  const float high_half = half_length_at_axis + ridge.x;
  Mesh mesh = quad_facing({-low_half, low.y, low.z}, {low_half, low.y, low.z},
                          {high_half, high.y, high.z}, {-high_half, high.y, high.z}, {0, 1, 0});
  const int runs = int(2.0f * low_half / tile_pitch);
  glm::mat4 slope(1.0f);
  slope[1] = glm::vec4(glm::cross(-up_slope, glm::vec3(1, 0, 0)), 0.0f);
  slope[2] = glm::vec4(-up_slope, 0.0f);
  const Mesh full_run = tile_run(slope_length, 3);
  for (int i = 0; i < runs; ++i) {
    const float x = (float(i) + 0.5f - 0.5f * float(runs)) * 2.0f * low_half / float(runs);
    mesh.append(full_run, glm::translate(glm::mat4(1.0f), low + glm::vec3(x, 0, 0)) * slope);
  }
  const float inward = -eaves.x;
  mesh.append(quad_facing({-low_half, low.y - 0.07f, low.z}, {low_half, low.y - 0.07f, low.z},
                          {low_half, low.y, low.z}, {-low_half, low.y, low.z}, {0, 0, 1}));
  mesh.append(quad_facing(
      {-low_half - inward, low.y - 0.07f, 0.0f}, {low_half + inward, low.y - 0.07f, 0.0f},
      {low_half, low.y - 0.07f, low.z}, {-low_half, low.y - 0.07f, low.z}, {0, -1, 0}));
  return mesh;
}

}  // namespace

void add_roof(Document& document, const AtriumMaterials& m) {
  const int long_side = document.add_mesh("roof", roof_side(plan::arcade.x), m.roof);
  const int short_side = document.add_mesh("roof_end", roof_side(plan::arcade.y), m.roof);
  for (const plan::Spot& side : plan::sides(0.0f)) {
    document.place(side.on_long_side ? long_side : short_side, side.at(0.0f), side.turn);
  }
}

}  // namespace heliograph::scenes
