// A tile of the frame in which the host's rasteriser finds the nearest triangles. Included once per
// instruction set; the guard is Google Highway's convention.
#if defined(HELIOGRAPH_KERNELS_TRIANGLE_TILE_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_TRIANGLE_TILE_HPP
#undef HELIOGRAPH_KERNELS_TRIANGLE_TILE_HPP
#else
#define HELIOGRAPH_KERNELS_TRIANGLE_TILE_HPP
#endif

#include <algorithm>
#include <limits>

#include "render/kernels/gbuffer/gbuffer_triangles.hpp"
#include "render/kernels/simd/lanes.hpp"
#include "shaders/shared/ray.h"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

class TriangleTile {
 public:
  static constexpr int size = triangle_tile;

  TriangleTile(int left, int top) : left_(left), top_(top) {
    nearness_.fill(-std::numeric_limits<float>::max());
    instance_.fill(static_cast<std::int32_t>(shared::hit_none));
  }

  /// Draws all triangles that cover the tile, in order: of equally near ones the first stays.
  void draw(const ScreenTriangles& triangles) {
    const auto count = static_cast<int>(triangles.batch_count);
    const int lanes = static_cast<int>(hn::Lanes(tag));
    for (int i = 0; i < count; i += lanes) {
      for (std::uint64_t bits = overlapping(triangles, i, count); bits; bits &= bits - 1) {
        draw(triangles.batches[static_cast<std::size_t>(i + __builtin_ctzll(bits))]);
      }
    }
  }

  /// Of the pixels from (x, y) on, which count from the tile's corner; shared::hit_none: nothing.
  HWY_INLINE Integer instance(int x, int y) const {
    return hn::LoadU(integer_tag, &instance_[at(x, y)]);
  }
  HWY_INLINE Integer triangle(int x, int y) const {
    return hn::LoadU(integer_tag, &triangle_[at(x, y)]);
  }

 private:
  static std::size_t at(int x, int y) { return static_cast<std::size_t>(y * size + x); }

  HWY_INLINE std::uint64_t overlapping(const ScreenTriangles& t, int first, int count) const {
    const auto at = static_cast<std::size_t>(first);
    if (first + static_cast<int>(hn::Lanes(tag)) > count) {
      std::uint64_t bits = 0;
      for (std::size_t i = at; i < static_cast<std::size_t>(count); ++i) {
        const bool apart = t.first_column[i] >= left_ + size || t.last_column[i] < left_ ||
                           t.first_row[i] >= top_ + size || t.last_row[i] < top_;
        bits |= std::uint64_t{!apart} << (i - at);
      }
      return bits;
    }
    const auto load = [at](const std::vector<std::int32_t>& from)
                          HWY_ATTR { return hn::LoadU(integer_tag, from.data() + at); };
    const auto across = hn::And(hn::Lt(load(t.first_column), integer(left_ + size)),
                                hn::Gt(load(t.last_column), integer(left_ - 1)));
    const auto down = hn::And(hn::Lt(load(t.first_row), integer(top_ + size)),
                              hn::Gt(load(t.last_row), integer(top_ - 1)));
    return mask_bits(float_mask(hn::And(across, down)));
  }

  void draw(const TriangleBatch& batch) {
    const auto instance = static_cast<std::int32_t>(batch.draw->constants.instance);
    for (const ScreenTriangle& triangle : batch.visible) {
      const int left = std::max(static_cast<int>(triangle.columns & 0xffffu) - left_, 0);
      const int right = std::min(static_cast<int>(triangle.columns >> 16) - left_, size - 1);
      const int top = std::max(static_cast<int>(triangle.rows & 0xffffu) - top_, 0);
      const int bottom = std::min(static_cast<int>(triangle.rows >> 16) - top_, size - 1);
      if (left <= right && top <= bottom) draw(triangle, instance, left, right, top, bottom);
    }
  }

  /// An edge function, 0 or above inside: its value at the first sample, and its change from pixel
  /// to pixel. In units of a whole pixel's change: what is lost of it cannot change its sign.
  struct Edge {
    std::int32_t start, right, down;
    Edge(const ScreenTriangle& t, int from, int to, std::int64_t x, std::int64_t y) {
      right = t.y[from] - t.y[to];
      down = t.x[to] - t.x[from];
      std::int64_t value =
          std::int64_t{down} * (y - t.y[from]) + std::int64_t{right} * (x - t.x[from]);
      // A sample on an edge that two triangles share belongs to one of them.
      value -= right > 0 || (right == 0 && down > 0) ? 0 : 1;
      value >>= subpixel_bits;
      // Farther off than the tile is large: the sign is the same all over.
      constexpr std::int64_t far = 1 << 30;
      start = static_cast<std::int32_t>(std::clamp(value, -far, far));
    }
  };

  HWY_INLINE void draw(const ScreenTriangle& t, std::int32_t instance, int left, int right, int top,
                       int bottom) {
    const int lanes = static_cast<int>(hn::Lanes(tag));
    left -= left % lanes;
    constexpr int pixel = 1 << subpixel_bits;
    const std::int64_t x = (left_ + left) * pixel + pixel / 2;
    const std::int64_t y = (top_ + top) * pixel + pixel / 2;
    const Edge edges[3]{{t, 0, 1, x, y}, {t, 1, 2, x, y}, {t, 2, 0, x, y}};
    const Integer iota = hn::Iota(integer_tag, 0);
    const auto lanes_of = [&](const Edge& edge) HWY_ATTR {
      return hn::Add(integer(edge.start), hn::Mul(integer(edge.right), iota));
    };
    Integer a = lanes_of(edges[0]), b = lanes_of(edges[1]), c = lanes_of(edges[2]);
    constexpr float scale = 1.0f / static_cast<float>(pixel);
    const float first = t.nearness + t.nearness_right * (static_cast<float>(x - t.x[0]) * scale) +
                        t.nearness_down * (static_cast<float>(y - t.y[0]) * scale);
    Float nearness = hn::MulAdd(number(t.nearness_right), to_float(iota), number(first));
    for (int row = top; row <= bottom; ++row) {
      Integer row_a = a, row_b = b, row_c = c;
      Float here = nearness;
      for (int column = left; column <= right; column += lanes) {
        const Mask inside = float_mask(hn::Gt(hn::Or(row_a, hn::Or(row_b, row_c)), integer(-1)));
        if (!none(inside)) put(t, instance, at(column, row), here, inside);
        row_a = hn::Add(row_a, integer(lanes * edges[0].right));
        row_b = hn::Add(row_b, integer(lanes * edges[1].right));
        row_c = hn::Add(row_c, integer(lanes * edges[2].right));
        here = here + number(static_cast<float>(lanes) * t.nearness_right);
      }
      a = hn::Add(a, integer(edges[0].down));
      b = hn::Add(b, integer(edges[1].down));
      c = hn::Add(c, integer(edges[2].down));
      nearness = nearness + number(t.nearness_down);
    }
  }

  HWY_INLINE void put(const ScreenTriangle& t, std::int32_t instance, std::size_t where,
                      Float nearness, Mask inside) {
    const Float before = hn::Load(tag, &nearness_[where]);
    const Mask nearer = hn::And(inside, hn::Gt(nearness, before));
    if (none(nearer)) return;
    hn::Store(select(nearer, nearness, before), tag, &nearness_[where]);
    const auto keep = [&](std::int32_t value, std::int32_t* to) HWY_ATTR {
      hn::Store(select(nearer, integer(value), hn::Load(integer_tag, to)), integer_tag, to);
    };
    keep(instance, &instance_[where]);
    keep(static_cast<std::int32_t>(t.triangle), &triangle_[where]);
  }

  int left_, top_;
  HWY_ALIGN std::array<float, size * size> nearness_;
  HWY_ALIGN std::array<std::int32_t, size * size> instance_;
  HWY_ALIGN std::array<std::int32_t, size * size> triangle_;
};

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
