#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "render/kernels/gbuffer/gbuffer_triangles.hpp"

/// The few triangles that reach beyond the frame or behind the eye, or are large, one by one.
namespace heliograph::render::kernels {

/// A corner before the division: x, y and w of clip space; metres along -Z.
struct ClipPoint {
  float x, y, w, depth;
};

/// A convex polygon: a triangle has at most one more corner for each plane that clips it. With room
/// for those that rounding makes.
struct ClippedPolygon {
  static constexpr std::size_t most = 12;
  std::array<ClipPoint, most> corners;
  std::size_t count = 0;
  void add(const ClipPoint& p) {
    if (count < most) corners[count++] = p;
  }
};

/// The part of a triangle beyond the near plane and within -x..x and -y..y times w.
ClippedPolygon clip_triangle(const std::array<ClipPoint, 3>& corners, double near_plane, double x,
                             double y);

/// 1/256 pixel, right and down.
struct ScreenCorner {
  std::int64_t x, y;
  double nearness;
};

/// Fronts of triangles and the frame that they lie in, pixels.
struct ScreenSides {
  bool double_sided;
  bool clockwise;  // what front faces are on the screen
  int width, height;
};

/// Nothing where the triangle faces away, lies outside the frame or between samples.
std::optional<ScreenTriangle> screen_triangle(const ScreenCorner& a, ScreenCorner b, ScreenCorner c,
                                              const ScreenSides& sides, std::uint32_t number);

}  // namespace heliograph::render::kernels
