#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/resources/host_tables.hpp"
#include "render/resources/scene_resources.hpp"
#include "shaders/shared/frame_constants.h"

namespace heliograph::render::kernels {

/// Triangles in view as the rasteriser of the host takes them.
///
/// Corners are in units of 1/256 pixel, right and down from the frame's corner, in the order in
/// which the front is to the left of every edge (on a screen whose y points down: clockwise).
/// Vertices that triangles share have the same coordinates, so that edge functions in whole numbers
/// leave no gap between them.
struct ScreenTriangle {
  std::int32_t x[3], y[3];
  std::uint32_t columns;  // of the pixels whose samples it may cover: first | last << 16
  std::uint32_t rows;     // likewise
  float nearness;         // at the first corner; grows toward the eye, linear on the screen
  float nearness_right;   // its change per pixel
  float nearness_down;
  std::uint32_t triangle;  // within the instance's mesh
};
static_assert(sizeof(ScreenTriangle) == 12 * 4);

inline constexpr int subpixel_bits = 8;

/// Boxes of pixels, each edge by itself, with room for a whole vector behind the last.
struct PixelBoxes {
  std::vector<std::int32_t> left, right, top, bottom;
  void resize(std::size_t count);
  void set(std::size_t at, std::int32_t left_edge, std::int32_t right_edge, std::int32_t top_edge,
           std::int32_t bottom_edge);
};

/// Consecutive triangles of one draw, and those of them that may cover a sample.
struct TriangleBatch {
  const Draw* draw;
  std::uint32_t first, count;
  std::vector<ScreenTriangle> visible;
  PixelBoxes boxes;  // of them
};

/// Triangles of a frame; kept from frame to frame, because memory is.
struct ScreenTriangles {
  std::vector<TriangleBatch> batches;
  std::size_t batch_count = 0;    // in this frame
  std::size_t first_passing = 0;  // of those that may let rays pass; they are the last
  PixelBoxes boxes;               // of the batches
};

/// Triangles of one batch at most.
inline constexpr std::uint32_t triangle_batch = 256;
/// Width and height of the tiles that are drawn one by one, pixels: a multiple of all vectors'
/// lanes.
inline constexpr int triangle_tile = 32;

/// Projects the triangles of `draws`, clips them to the near plane, and leaves out those that face
/// away, lie outside the frame or between samples; on all processors. Masked and blended draws are
/// the last.
void project_triangles(const shared::FrameConstants& frame, const SceneView& scene,
                       std::span<const Draw* const> draws, ScreenTriangles& to);

}  // namespace heliograph::render::kernels
