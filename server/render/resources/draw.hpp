#pragma once

#include <cstdint>
#include <optional>

#include "scene/scene.hpp"

namespace heliograph::render {

/// One instance as the rasteriser draws it.
struct Draw {
  shared::DrawConstants constants;
  std::uint32_t material;
  std::uint32_t first_index;
  std::uint32_t index_count;
  std::uint32_t first_vertex;
  // Where its vertices of the frame before start among those of all meshes that deform.
  std::optional<std::uint32_t> previous_vertex;
  bool masked;  // alpha mask or blend: the program that discards
  bool double_sided;
  bool flipped;
  scene::Bounds bounds;  // world
};

}  // namespace heliograph::render
