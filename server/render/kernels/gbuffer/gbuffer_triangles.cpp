#include "render/kernels/gbuffer/gbuffer_triangles.hpp"

#include <array>

#include "render/kernels/gbuffer/triangle_clipping.hpp"
#include "render/kernels/simd/rows.hpp"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/gbuffer/gbuffer_triangles.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/simd/lanes.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// Positions before the division: of clip space x, y and w; and metres along -Z.
struct ClipLanes {
  Float x, y, w, depth;
};

struct CornerLanes {
  Integer x, y;  // 1/256 pixel
  Float nearness;
};

/// One batch of triangles.
class Projection {
 public:
  Projection(const shared::FrameConstants& frame, const SceneView& scene, TriangleBatch& batch)
      : scene_(scene),
        batch_(batch),
        orthographic_((frame.flags & shared::frame_orthographic) != 0),
        // What rays begin at: the near plane is what the reversed projection leaves of every depth.
        near_plane_(orthographic_ ? 0.0f : frame.unjittered[3][2]),
        width_(static_cast<int>(frame.extent.x)),
        height_(static_cast<int>(frame.extent.y)) {
    const auto& rows = batch.draw->constants.world;
    const glm::mat4 world =
        glm::transpose(glm::mat4(rows[0], rows[1], rows[2], glm::vec4(0, 0, 0, 1)));
    to_clip_ = frame.view_projection * world;
    to_view_ = frame.view * world;
    // glTF's fronts are counter-clockwise as seen, which is clockwise where y points down.
    turned_ = batch.draw->flipped;
  }

  void run() {
    const int last = static_cast<int>(batch_.first + batch_.count);
    const int lanes = static_cast<int>(hn::Lanes(tag));
    for (int i = static_cast<int>(batch_.first); i < last; i += lanes) block(i, last);
  }

 private:
  // Beyond the frame by so many pixels triangles are clipped: coordinates stay within 23 bits.
  static constexpr float guard = 4096.0f;
  // Larger ones are set up in 64 bits.
  static constexpr int most_pixels = 120;

  void block(int first, int last) {
    const Integer triangle = hn::Min(hn::Iota(integer_tag, first), integer(last - 1));
    const Integer index =
        hn::Add(integer(static_cast<int>(batch_.draw->first_index)), hn::Mul(triangle, integer(3)));
    std::array<ClipLanes, 3> corners;
    for (int i = 0; i < 3; ++i) corners[static_cast<std::size_t>(i)] = corner(index, i);
    const auto& [a, b, c] = corners;
    Mask seen = float_mask(hn::Lt(hn::Iota(integer_tag, first), integer(last)));
    const auto beyond = [&](auto distance) HWY_ATTR {
      const Mask all = hn::And(hn::Lt(distance(a), zero()),
                               hn::And(hn::Lt(distance(b), zero()), hn::Lt(distance(c), zero())));
      seen = hn::AndNot(all, seen);
    };
    const Float near_plane = number(near_plane_);
    beyond([=](const ClipLanes& p) HWY_ATTR { return p.depth - near_plane; });
    beyond([](const ClipLanes& p) HWY_ATTR { return p.w + p.x; });
    beyond([](const ClipLanes& p) HWY_ATTR { return p.w - p.x; });
    beyond([](const ClipLanes& p) HWY_ATTR { return p.w + p.y; });
    beyond([](const ClipLanes& p) HWY_ATTR { return p.w - p.y; });
    if (none(seen)) return;

    Mask whole = hn::And(inside(a), hn::And(inside(b), inside(c)));
    std::array<CornerLanes, 3> on_screen{screen(a), screen(b), screen(c)};
    whole = hn::And(whole, is_small(on_screen));
    const Mask fast = hn::And(seen, whole);
    if (!none(fast)) emit(on_screen, triangle, fast);
    const Mask slow = hn::AndNot(whole, seen);
    if (!none(slow)) emit_clipped(corners, first, slow);
  }

  HWY_INLINE ClipLanes corner(Integer first_index, int number_of) const {
    const LaneIndices<Tag> vertex(gather(scene_.indices, hn::Add(first_index, integer(number_of))));
    const shared::Vertex* const vertices = scene_.vertices + batch_.draw->first_vertex;
    const Float4 words = four_words(tag, [&](std::size_t lane) {
      return &vertices[static_cast<std::uint32_t>(vertex.of[lane])].position.x;
    });
    const Float3 p{words.x, words.y, words.z};
    return {transform_row(to_clip_, 0, p), transform_row(to_clip_, 1, p),
            orthographic_ ? one() : transform_row(to_clip_, 3, p),
            hn::Neg(transform_row(to_view_, 2, p))};
  }

  /// In front of the near plane and not far outside the frame.
  HWY_INLINE Mask inside(const ClipLanes& p) const {
    const Float x = p.w * number(limit(width_)), y = p.w * number(limit(height_));
    return hn::And(hn::Ge(p.depth, number(near_plane_)),
                   hn::And(hn::Le(hn::Abs(p.x), x), hn::Le(hn::Abs(p.y), y)));
  }
  static float limit(int size) { return 1.0f + 2.0f * guard / static_cast<float>(size); }

  HWY_INLINE CornerLanes screen(const ClipLanes& p) const {
    const Float by = one() / p.w;
    const auto fixed = [&](Float clip, int size) HWY_ATTR {
      const Float half = number(0.5f * static_cast<float>(size << subpixel_bits));
      return hn::NearestInt(hn::MulAdd(clip * by, half, half));
    };
    return {fixed(p.x, width_), fixed(p.y, height_), orthographic_ ? hn::Neg(p.depth) : by};
  }

  /// Small enough for products of two differences in 32 bits.
  HWY_INLINE Mask is_small(const std::array<CornerLanes, 3>& p) const {
    const auto extent = [](Integer a, Integer b, Integer c) HWY_ATTR {
      return hn::Sub(hn::Max(a, hn::Max(b, c)), hn::Min(a, hn::Min(b, c)));
    };
    const Integer most = integer(most_pixels << subpixel_bits);
    return float_mask(hn::And(hn::Lt(extent(p[0].x, p[1].x, p[2].x), most),
                              hn::Lt(extent(p[0].y, p[1].y, p[2].y), most)));
  }

  /// The first pixel whose sample lies at or after `low`, the last whose sample lies at or before
  /// `high`, within `size` pixels.
  static HWY_INLINE void pixels_between(Integer low, Integer high, int size, Integer& first,
                                        Integer& last) {
    constexpr int half = 1 << (subpixel_bits - 1);
    first = hn::ShiftRight<subpixel_bits>(hn::Add(low, integer(half - 1)));
    last = hn::ShiftRight<subpixel_bits>(hn::Sub(high, integer(half)));
    first = hn::Max(first, integer(0));
    last = hn::Min(last, integer(size - 1));
  }

  void emit(const std::array<CornerLanes, 3>& p, Integer triangle, Mask seen) {
    const CornerLanes& a = p[0];
    // The order that puts the front to the left of the edges.
    const auto ordered = [&](const CornerLanes& first, const CornerLanes& second,
                             Mask swapped) HWY_ATTR {
      return CornerLanes{select(swapped, second.x, first.x), select(swapped, second.y, first.y),
                         select(swapped, second.nearness, first.nearness)};
    };
    const auto cross_of = [&](const CornerLanes& second, const CornerLanes& third) HWY_ATTR {
      return hn::Sub(hn::Mul(hn::Sub(second.x, a.x), hn::Sub(third.y, a.y)),
                     hn::Mul(hn::Sub(third.x, a.x), hn::Sub(second.y, a.y)));
    };
    const Integer signed_area = cross_of(p[1], p[2]);
    const Mask clockwise = float_mask(hn::Gt(signed_area, integer(0)));
    const Mask anticlockwise = float_mask(hn::Lt(signed_area, integer(0)));
    if (batch_.draw->double_sided) {
      seen = hn::And(seen, hn::Or(clockwise, anticlockwise));
    } else {
      seen = hn::And(seen, turned_ ? clockwise : anticlockwise);
    }
    const CornerLanes b = ordered(p[1], p[2], anticlockwise);
    const CornerLanes c = ordered(p[2], p[1], anticlockwise);
    Integer first_column, last_column, first_row, last_row;
    pixels_between(hn::Min(a.x, hn::Min(b.x, c.x)), hn::Max(a.x, hn::Max(b.x, c.x)), width_,
                   first_column, last_column);
    pixels_between(hn::Min(a.y, hn::Min(b.y, c.y)), hn::Max(a.y, hn::Max(b.y, c.y)), height_,
                   first_row, last_row);
    const auto misses = hn::Or(hn::Gt(first_column, last_column), hn::Gt(first_row, last_row));
    seen = hn::AndNot(float_mask(misses), seen);
    if (none(seen)) return;
    const auto few = hn::And(hn::Lt(hn::Sub(last_column, first_column), integer(2)),
                             hn::Lt(hn::Sub(last_row, first_row), integer(2)));
    const Mask small = hn::And(seen, float_mask(few));
    if (!none(small)) {
      const Mask covers = covers_sample(a, b, c, first_column, last_column, first_row, last_row);
      seen = hn::AndNot(hn::AndNot(covers, small), seen);
      if (none(seen)) return;
    }

    const Float area = to_float(hn::Abs(signed_area));
    const Float pixel = number(static_cast<float>(1 << subpixel_bits));
    const auto difference = [](Integer to, Integer from)
                                HWY_ATTR { return to_float(hn::Sub(to, from)); };
    const Float bx = difference(b.x, a.x), by = difference(b.y, a.y);
    const Float cx = difference(c.x, a.x), cy = difference(c.y, a.y);
    const Float bz = b.nearness - a.nearness, cz = c.nearness - a.nearness;
    const Float scale = pixel / area;
    const Float right = hn::MulSub(bz, cy, cz * by) * scale;
    const Float down = hn::MulSub(cz, bx, bz * cx) * scale;
    const auto packed = [](Integer low, Integer high)
                            HWY_ATTR { return as_float(hn::Or(low, hn::ShiftLeft<16>(high))); };
    store({as_float(a.x), as_float(b.x), as_float(c.x), as_float(a.y)},
          {as_float(b.y), as_float(c.y), packed(first_column, last_column),
           packed(first_row, last_row)},
          {a.nearness, right, down, as_float(triangle)}, seen);
  }

  /// Whether any of at most 2 x 2 samples lies inside: most of the smallest triangles lie between
  /// them. By the edge functions of TriangleTile.
  static HWY_INLINE Mask covers_sample(const CornerLanes& a, const CornerLanes& b,
                                       const CornerLanes& c, Integer first_column,
                                       Integer last_column, Integer first_row, Integer last_row) {
    const auto sample = [](Integer pixel) HWY_ATTR {
      return hn::Add(hn::ShiftLeft<subpixel_bits>(pixel), integer(1 << (subpixel_bits - 1)));
    };
    const Integer x = sample(first_column), y = sample(first_row);
    const Integer right = hn::Sub(last_column, first_column);
    const Integer down = hn::Sub(last_row, first_row);
    // The sign of what lies outside any edge, at each of the samples.
    Integer outside[4]{integer(0), integer(0), integer(0), integer(0)};
    const auto add_edge = [&](const CornerLanes& from, const CornerLanes& to) HWY_ATTR {
      const Integer by_x = hn::Sub(from.y, to.y), by_y = hn::Sub(to.x, from.x);
      const auto owns = hn::Or(hn::Gt(by_x, integer(0)),
                               hn::And(hn::Eq(by_x, integer(0)), hn::Gt(by_y, integer(0))));
      Integer value = hn::Add(hn::Mul(by_y, hn::Sub(y, from.y)), hn::Mul(by_x, hn::Sub(x, from.x)));
      value = hn::Sub(value, hn::IfThenZeroElse(owns, integer(1)));
      const Integer step_x = hn::ShiftLeft<subpixel_bits>(hn::Mul(by_x, right));
      const Integer step_y = hn::ShiftLeft<subpixel_bits>(hn::Mul(by_y, down));
      outside[0] = hn::Or(outside[0], value);
      outside[1] = hn::Or(outside[1], hn::Add(value, step_x));
      outside[2] = hn::Or(outside[2], hn::Add(value, step_y));
      outside[3] = hn::Or(outside[3], hn::Add(value, hn::Add(step_x, step_y)));
    };
    add_edge(a, b);
    add_edge(b, c);
    add_edge(c, a);
    const Integer all = hn::And(hn::And(outside[0], outside[1]), hn::And(outside[2], outside[3]));
    return float_mask(hn::Gt(all, integer(-1)));
  }

  void store(const Float4& first, const Float4& second, const Float4& third, Mask seen) {
    constexpr std::size_t most = 4 * hn::MaxLanes(Tag());
    HWY_ALIGN std::array<float, most> a, b, c;
    store4(tag, first, a.data());
    store4(tag, second, b.data());
    store4(tag, third, c.data());
    for (std::uint64_t lanes = mask_bits(seen); lanes; lanes &= lanes - 1) {
      const auto lane = static_cast<std::size_t>(__builtin_ctzll(lanes));
      ScreenTriangle& to = batch_.visible.emplace_back();
      auto* const bytes = reinterpret_cast<std::byte*>(&to);
      std::memcpy(bytes, &a[4 * lane], 16);
      std::memcpy(bytes + 16, &b[4 * lane], 16);
      std::memcpy(bytes + 32, &c[4 * lane], 16);
    }
  }

  void emit_clipped(const std::array<ClipLanes, 3>& corners, int first, Mask lanes) {
    constexpr std::size_t most = hn::MaxLanes(Tag());
    HWY_ALIGN std::array<std::array<float, 4 * most>, 3> points;
    for (std::size_t i = 0; i < 3; ++i) {
      const ClipLanes& p = corners[i];
      store4(tag, Float4{p.x, p.y, p.w, p.depth}, points[i].data());
    }
    for (std::uint64_t bits = mask_bits(lanes); bits; bits &= bits - 1) {
      const auto lane = static_cast<std::size_t>(__builtin_ctzll(bits));
      std::array<ClipPoint, 3> triangle;
      for (std::size_t i = 0; i < 3; ++i) {
        const float* const p = &points[i][4 * lane];
        triangle[i] = {p[0], p[1], p[2], p[3]};
      }
      emit_polygon(triangle, static_cast<std::uint32_t>(first) + static_cast<std::uint32_t>(lane));
    }
  }

  void emit_polygon(const std::array<ClipPoint, 3>& points, std::uint32_t triangle) {
    const ClippedPolygon polygon =
        clip_triangle(points, near_plane_, limit(width_), limit(height_));
    if (polygon.count < 3) return;
    std::array<ScreenCorner, ClippedPolygon::most> corners;
    for (std::size_t i = 0; i < polygon.count; ++i) corners[i] = screen(polygon.corners[i]);
    const ScreenSides sides{batch_.draw->double_sided, turned_, width_, height_};
    for (std::size_t i = 2; i < polygon.count; ++i) {
      const auto made = screen_triangle(corners[0], corners[i - 1], corners[i], sides, triangle);
      if (made) batch_.visible.push_back(*made);
    }
  }

  /// By the same instructions as whole triangles' corners, so that shared ones fall together.
  ScreenCorner screen(const ClipPoint& p) const {
    const CornerLanes lanes = screen({number(p.x), number(p.y), number(p.w), number(p.depth)});
    return {hn::GetLane(lanes.x), hn::GetLane(lanes.y), hn::GetLane(lanes.nearness)};
  }

  const SceneView& scene_;
  TriangleBatch& batch_;
  bool orthographic_;
  float near_plane_;
  int width_, height_;
  glm::mat4 to_clip_, to_view_;
  bool turned_;
};

void project_batch(const shared::FrameConstants& frame, const SceneView& scene,
                   TriangleBatch& batch) {
  Projection(frame, scene, batch).run();
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {
namespace {

/// The left edge of a box that lies in no tile.
constexpr std::int32_t nowhere = 0x7fffff;

/// Batches of the draws, with what an earlier frame has allocated.
void list_batches(std::span<const Draw* const> draws, ScreenTriangles& to) {
  to.batch_count = to.first_passing = 0;
  for (const Draw* const draw : draws) {
    const std::uint32_t triangles = draw->index_count / 3;
    for (std::uint32_t first = 0; first < triangles; first += triangle_batch) {
      if (to.batch_count == to.batches.size()) to.batches.emplace_back();
      TriangleBatch& batch = to.batches[to.batch_count++];
      batch.draw = draw;
      batch.first = first;
      batch.count = std::min(triangle_batch, triangles - first);
      batch.visible.clear();
    }
    if (!draw->masked) to.first_passing = to.batch_count;
  }
}

/// The boxes of the visible triangles, and that of all of them in `batches`.
void list_boxes(TriangleBatch& batch, std::size_t number, PixelBoxes& batches) {
  batch.boxes.resize(batch.visible.size());
  std::int32_t left = nowhere, right = 0, top = nowhere, bottom = 0;
  for (std::size_t i = 0; i < batch.visible.size(); ++i) {
    const ScreenTriangle& triangle = batch.visible[i];
    const auto edge = [](std::uint32_t packed) { return static_cast<std::int32_t>(packed); };
    const std::int32_t first_column = edge(triangle.columns & 0xffffu);
    const std::int32_t last_column = edge(triangle.columns >> 16);
    const std::int32_t first_row = edge(triangle.rows & 0xffffu);
    const std::int32_t last_row = edge(triangle.rows >> 16);
    batch.boxes.set(i, first_column, last_column, first_row, last_row);
    left = std::min(left, first_column);
    right = std::max(right, last_column);
    top = std::min(top, first_row);
    bottom = std::max(bottom, last_row);
  }
  batches.set(number, left, right, top, bottom);
}

}  // namespace

void PixelBoxes::resize(std::size_t count) {
  constexpr std::size_t room = 16;  // lanes of the widest vectors
  left.assign(count + room, nowhere);
  for (auto* const edge : {&right, &top, &bottom}) edge->resize(count + room);
}

void PixelBoxes::set(std::size_t at, std::int32_t left_edge, std::int32_t right_edge,
                     std::int32_t top_edge, std::int32_t bottom_edge) {
  left[at] = left_edge;
  right[at] = right_edge;
  top[at] = top_edge;
  bottom[at] = bottom_edge;
}

HWY_EXPORT(project_batch);

void project_triangles(const shared::FrameConstants& frame, const SceneView& scene,
                       std::span<const Draw* const> draws, ScreenTriangles& to) {
  list_batches(draws, to);
  to.boxes.resize(to.batch_count);
  for_each_range(static_cast<int>(to.batch_count), 8, [&](int first, int last) {
    for (int i = first; i < last; ++i) {
      const auto number = static_cast<std::size_t>(i);
      TriangleBatch& batch = to.batches[number];
      HWY_DYNAMIC_DISPATCH(project_batch)(frame, scene, batch);
      list_boxes(batch, number, to.boxes);
    }
  });
}

}  // namespace heliograph::render::kernels
#endif
