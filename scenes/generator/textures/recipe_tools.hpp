#pragma once

#include <algorithm>
#include <glm/glm.hpp>

namespace heliograph::scenes::recipes {

inline float smooth_step(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

inline glm::vec3 blend(glm::vec3 a, glm::vec3 b, float t) {
  return glm::mix(a, b, std::clamp(t, 0.0f, 1.0f));
}

/// Distance with the shortest way round a tile of period 1.
inline glm::vec2 wrapped_offset(glm::vec2 from, glm::vec2 to) {
  const glm::vec2 d = to - from;
  return d - glm::round(d);
}

/// Where a point lies in a wall of blocks laid in running bond.
struct Block {
  int column = 0;
  int row = 0;
  glm::vec2 local{0.0f};       // 0..1 inside the block
  float edge_distance = 0.0f;  // in tiles, to the nearest joint
};

inline Block block_at(glm::vec2 uv, int columns, int rows, float shift_of_odd_rows = 0.5f) {
  Block block;
  const float y = uv.y * float(rows);
  block.row = int(y) % rows;
  float x = uv.x * float(columns) + (block.row % 2 == 1 ? shift_of_odd_rows : 0.0f);
  x -= x >= float(columns) ? float(columns) : 0.0f;
  block.column = int(x);
  block.local = {x - glm::floor(x), y - glm::floor(y)};
  const float along = std::min(block.local.x, 1.0f - block.local.x) / float(columns);
  const float up = std::min(block.local.y, 1.0f - block.local.y) / float(rows);
  block.edge_distance = std::min(along, up);
  return block;
}

}  // namespace heliograph::scenes::recipes
