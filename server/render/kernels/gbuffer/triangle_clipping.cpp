#include "render/kernels/gbuffer/triangle_clipping.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace heliograph::render::kernels {
namespace {

/// What lies where `distance` >= 0.
template <class Distance>
ClippedPolygon clip_polygon(const ClippedPolygon& from, const Distance& distance) {
  ClippedPolygon to;
  for (std::size_t i = 0; i < from.count; ++i) {
    const ClipPoint &p = from.corners[i], &q = from.corners[(i + 1) % from.count];
    const double at_p = distance(p), at_q = distance(q);
    if (at_p >= 0.0) to.add(p);
    if ((at_p >= 0.0) == (at_q >= 0.0)) continue;
    // From the inside out, whichever triangle the edge is of: both get the same point.
    const bool leaves = at_p >= 0.0;
    const ClipPoint &in = leaves ? p : q, &out = leaves ? q : p;
    const double along = (leaves ? at_p : at_q) / std::abs(at_p - at_q);
    const auto between = [along](float near, float far) {
      return static_cast<float>(near + along * (double{far} - near));
    };
    to.add({between(in.x, out.x), between(in.y, out.y), between(in.w, out.w),
            between(in.depth, out.depth)});
  }
  return to;
}

}  // namespace

ClippedPolygon clip_triangle(const std::array<ClipPoint, 3>& corners, double near_plane, double x,
                             double y) {
  ClippedPolygon polygon;
  for (const ClipPoint& corner : corners) polygon.add(corner);
  polygon = clip_polygon(polygon, [=](const ClipPoint& p) { return p.depth - near_plane; });
  polygon = clip_polygon(polygon, [=](const ClipPoint& p) { return x * p.w - p.x; });
  polygon = clip_polygon(polygon, [=](const ClipPoint& p) { return x * p.w + p.x; });
  polygon = clip_polygon(polygon, [=](const ClipPoint& p) { return y * p.w - p.y; });
  return clip_polygon(polygon, [=](const ClipPoint& p) { return y * p.w + p.y; });
}

std::optional<ScreenTriangle> screen_triangle(const ScreenCorner& a, ScreenCorner b, ScreenCorner c,
                                              const ScreenSides& sides, std::uint32_t number) {
  std::int64_t area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
  if (area == 0) return std::nullopt;
  const bool clockwise = area > 0;
  if (!sides.double_sided && clockwise != sides.clockwise) return std::nullopt;
  if (!clockwise) {
    std::swap(b, c);
    area = -area;
  }
  const auto first_pixel = [](std::int64_t low) {
    return std::max<std::int64_t>((low + 127) >> subpixel_bits, 0);
  };
  const auto last_pixel = [](std::int64_t high, int size) {
    return std::min<std::int64_t>((high - 128) >> subpixel_bits, size - 1);
  };
  const std::int64_t left = first_pixel(std::min({a.x, b.x, c.x}));
  const std::int64_t right = last_pixel(std::max({a.x, b.x, c.x}), sides.width);
  const std::int64_t top = first_pixel(std::min({a.y, b.y, c.y}));
  const std::int64_t bottom = last_pixel(std::max({a.y, b.y, c.y}), sides.height);
  if (left > right || top > bottom) return std::nullopt;
  const double scale = static_cast<double>(1 << subpixel_bits) / static_cast<double>(area);
  const auto difference = [](std::int64_t to, std::int64_t from) {
    return static_cast<double>(to - from);
  };
  const double bz = b.nearness - a.nearness, cz = c.nearness - a.nearness;
  const double to_right = (bz * difference(c.y, a.y) - cz * difference(b.y, a.y)) * scale;
  const double to_below = (cz * difference(b.x, a.x) - bz * difference(c.x, a.x)) * scale;
  const auto whole = [](std::int64_t v) { return static_cast<std::int32_t>(v); };
  const auto packed = [](std::int64_t low, std::int64_t high) {
    return static_cast<std::uint32_t>(low | high << 16);
  };
  return ScreenTriangle{{whole(a.x), whole(b.x), whole(c.x)},
                        {whole(a.y), whole(b.y), whole(c.y)},
                        packed(left, right),
                        packed(top, bottom),
                        static_cast<float>(a.nearness),
                        static_cast<float>(to_right),
                        static_cast<float>(to_below),
                        number};
}

}  // namespace heliograph::render::kernels
