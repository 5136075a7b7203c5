// A tile of the frame in which the host's rasteriser finds the nearest triangles. Included once per
// instruction set; the guard is Google Highway's convention.
#if defined(HELIOGRAPH_KERNELS_TRIANGLE_TILE_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_TRIANGLE_TILE_HPP
#undef HELIOGRAPH_KERNELS_TRIANGLE_TILE_HPP
#else
#define HELIOGRAPH_KERNELS_TRIANGLE_TILE_HPP
#endif

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/kernels/gbuffer/gbuffer_triangles.hpp"
#include "render/kernels/simd/lanes.hpp"
#include "shaders/shared/ray.h"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

class TriangleTile {
 public:
  static constexpr int size = triangle_tile;

  static constexpr std::size_t pixels = std::size_t{size} * size;

  TriangleTile(int left, int top) : left_(left), top_(top) {
    nearest_.nearness.fill(lowest);
    nearest_.instance.fill(static_cast<std::int32_t>(shared::hit_none));
  }

  /// Draws all triangles that cover the tile, in order: of equally near ones the first stays.
  /// @return whether any that may let rays pass is among them
  bool draw(const ScreenTriangles& triangles) {
    for_each_inside(triangles.boxes, 0, triangles.first_passing,
                    [&](std::size_t i) { draw<false>(triangles.batches[i]); });
    bool passing = false;
    for_each_inside(triangles.boxes, triangles.first_passing, triangles.batch_count,
                    [&](std::size_t i) {
                      if (!passing) {
                        solid_ = nearest_;
                        limits_.fill(lowest);
                      }
                      passing = true;
                      draw<false>(triangles.batches[i]);
                    });
    return passing;
  }

  /// Pixels let their rays pass: the next layer is what lies behind the present one.
  /// `number` counts pixels from the tile's corner, row by row.
  void pass(std::size_t number) {
    // As far behind as rays begin again.
    const float nearness = nearest_.nearness[number];
    limits_[number] = nearness - std::abs(nearness) * 1e-6f;
  }
  void stop(std::size_t number) { limits_[number] = lowest; }

  /// Draws the next layer of the pixels that let their rays pass; all others are left undefined.
  void draw_behind(const ScreenTriangles& triangles) {
    nearest_ = solid_;
    for_each_inside(triangles.boxes, triangles.first_passing, triangles.batch_count,
                    [&](std::size_t i) { draw<true>(triangles.batches[i]); });
  }

  /// Of the pixels from `number` on; shared::hit_none: nothing.
  HWY_INLINE Integer instances(std::size_t number) const {
    return hn::LoadU(integer_tag, &nearest_.instance[number]);
  }
  HWY_INLINE Integer triangles(std::size_t number) const {
    return hn::LoadU(integer_tag, &nearest_.triangle[number]);
  }
  /// Of pixels anywhere in the tile.
  HWY_INLINE Integer instances_at(Integer numbers) const {
    return gather(nearest_.instance.data(), numbers);
  }
  HWY_INLINE Integer triangles_at(Integer numbers) const {
    return gather(nearest_.triangle.data(), numbers);
  }

 private:
  static constexpr float lowest = -std::numeric_limits<float>::max();

  static std::size_t at(int x, int y) { return static_cast<std::size_t>(y * size + x); }

  /// `behind`: only what lies behind the limits.
  template <bool behind>
  void draw(const TriangleBatch& batch) {
    const auto instance = static_cast<std::int32_t>(batch.draw->constants.instance);
    for_each_inside(batch.boxes, 0, batch.visible.size(),
                    [&](std::size_t k) { draw<behind>(batch.visible[k], instance); });
  }

  /// Calls `work` for all boxes from `first` to before `last` that overlap the tile, in order.
  template <class Work>
  HWY_INLINE void for_each_inside(const PixelBoxes& boxes, std::size_t first, std::size_t last,
                                  const Work& work) const {
    for (std::size_t i = first; i < last; i += hn::Lanes(tag)) {
      const auto load = [i](const std::vector<std::int32_t>& edge)
                            HWY_ATTR { return hn::LoadU(integer_tag, edge.data() + i); };
      const auto across = hn::And(hn::Lt(load(boxes.left), integer(left_ + size)),
                                  hn::Gt(load(boxes.right), integer(left_ - 1)));
      const auto down = hn::And(hn::Lt(load(boxes.top), integer(top_ + size)),
                                hn::Gt(load(boxes.bottom), integer(top_ - 1)));
      const Mask listed = hn::FirstN(tag, last - i);
      std::uint64_t bits = mask_bits(hn::And(listed, float_mask(hn::And(across, down))));
      for (; bits; bits &= bits - 1) work(i + static_cast<std::size_t>(__builtin_ctzll(bits)));
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

  /// Columns between which rows may lie inside all edges, counted from the first sample.
  struct Spans {
    HWY_ALIGN std::array<std::int32_t, size> first, last;
  };

  /// Of rows `first_row` to `first_row` + lanes. @return a bit for each that has any column
  static HWY_INLINE std::uint64_t find_spans(const Edge (&edges)[3], int first_row, int width,
                                             Spans& spans) {
    Float low = zero(), high = number(static_cast<float>(width - 1));
    for (const Edge& edge : edges) {
      const Integer value = hn::Add(integer(edge.start),
                                    hn::Mul(integer(edge.down), hn::Iota(integer_tag, first_row)));
      if (edge.right == 0) {
        high = select(float_mask(hn::Lt(value, integer(0))), number(-1.0f), high);
        continue;
      }
      const Float crossed = to_float(value) * number(-1.0f / static_cast<float>(edge.right));
      // One column too many does no harm.
      constexpr float rounding = 1e-2f;
      if (edge.right > 0) low = hn::Max(low, crossed - number(rounding));
      if (edge.right < 0) high = hn::Min(high, crossed + number(rounding));
    }
    const Float first = hn::Ceil(hn::Min(low, number(static_cast<float>(size))));
    const Float last = hn::Floor(hn::Max(high, number(-1.0f)));
    const auto from = static_cast<std::size_t>(first_row);
    hn::StoreU(truncated(first), integer_tag, &spans.first[from]);
    hn::StoreU(truncated(last), integer_tag, &spans.last[from]);
    return mask_bits(hn::Le(first, last)) << first_row;
  }

  template <bool behind>
  HWY_INLINE void draw(const ScreenTriangle& t, std::int32_t instance) {
    const int lanes = static_cast<int>(hn::Lanes(tag));
    int left = std::max(static_cast<int>(t.columns & 0xffffu) - left_, 0);
    left -= left % lanes;
    const int right = std::min(static_cast<int>(t.columns >> 16) - left_, size - 1);
    const int top = std::max(static_cast<int>(t.rows & 0xffffu) - top_, 0);
    const int bottom = std::min(static_cast<int>(t.rows >> 16) - top_, size - 1);
    const int width = right - left + 1, height = bottom - top + 1;
    constexpr int pixel = 1 << subpixel_bits;
    const std::int64_t x = (left_ + left) * pixel + pixel / 2;
    const std::int64_t y = (top_ + top) * pixel + pixel / 2;
    const Edge edges[3]{{t, 0, 1, x, y}, {t, 1, 2, x, y}, {t, 2, 0, x, y}};
    const Integer iota = hn::Iota(integer_tag, 0);
    const Integer a = hn::Mul(integer(edges[0].right), iota);
    const Integer b = hn::Mul(integer(edges[1].right), iota);
    const Integer c = hn::Mul(integer(edges[2].right), iota);
    constexpr float scale = 1.0f / static_cast<float>(pixel);
    const float nearness = t.nearness +
                           t.nearness_right * (static_cast<float>(x - t.x[0]) * scale) +
                           t.nearness_down * (static_cast<float>(y - t.y[0]) * scale);
    const Float nearer = number(t.nearness_right) * to_float(iota);
    // Most of a large box may lie outside a thin triangle.
    constexpr int few = 4;
    const bool all = height * ((width + lanes - 1) / lanes) <= few;
    Spans spans;
    std::uint64_t rows = 0;
    for (int row = 0; row < height && !all; row += lanes) {
      rows |= find_spans(edges, row, width, spans);
    }
    const std::uint64_t in_box = (std::uint64_t{1} << height) - 1;
    for (rows = all ? in_box : rows & in_box; rows; rows &= rows - 1) {
      const int row = __builtin_ctzll(rows);
      const auto which = static_cast<std::size_t>(row);
      const int first = all ? 0 : spans.first[which] & -lanes;
      const int last = all ? width - 1 : spans.last[which];
      for (int column = first; column <= last; column += lanes) {
        const auto value = [&](const Edge& edge, Integer right_of) HWY_ATTR {
          return hn::Add(integer(edge.start + edge.down * row + edge.right * column), right_of);
        };
        const Integer outside =
            hn::Or(value(edges[0], a), hn::Or(value(edges[1], b), value(edges[2], c)));
        const Mask inside = float_mask(hn::Gt(outside, integer(-1)));
        if (none(inside)) continue;
        const float here = nearness + t.nearness_right * static_cast<float>(column) +
                           t.nearness_down * static_cast<float>(row);
        put<behind>(t, instance, at(left + column, top + row), number(here) + nearer, inside);
      }
    }
  }

  template <bool behind>
  HWY_INLINE void put(const ScreenTriangle& t, std::int32_t instance, std::size_t where,
                      Float nearness, Mask inside) {
    const Float before = hn::Load(tag, &nearest_.nearness[where]);
    Mask nearer = hn::And(inside, hn::Gt(nearness, before));
    if constexpr (behind) {
      nearer = hn::And(nearer, hn::Lt(nearness, hn::Load(tag, &limits_[where])));
    }
    if (none(nearer)) return;
    hn::Store(select(nearer, nearness, before), tag, &nearest_.nearness[where]);
    const auto keep = [&](std::int32_t value, std::int32_t* to) HWY_ATTR {
      hn::Store(select(nearer, integer(value), hn::Load(integer_tag, to)), integer_tag, to);
    };
    keep(instance, &nearest_.instance[where]);
    keep(static_cast<std::int32_t>(t.triangle), &nearest_.triangle[where]);
  }

  struct Layer {
    HWY_ALIGN std::array<float, pixels> nearness;
    HWY_ALIGN std::array<std::int32_t, pixels> instance;
    HWY_ALIGN std::array<std::int32_t, pixels> triangle;
  };

  int left_, top_;
  Layer nearest_;
  Layer solid_;  // of triangles that let no ray pass
  HWY_ALIGN std::array<float, pixels> limits_;
};

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
