#include "render/kernels/gbuffer/gbuffer_draw.hpp"

#include "render/kernels/simd/rows.hpp"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/gbuffer/gbuffer_draw.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/blend/blended_layer.hpp"
#include "render/kernels/gbuffer/gbuffer_shading.hpp"
#include "render/kernels/gbuffer/triangle_tile.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// `Surface`: SurfaceLanes, or LayeredSurfaceLanes.
template <class Surface>
class TileShading {
  using Shading = GBufferShading<Surface>;
  using AllTexels = TexelsOf<Surface>;
  static constexpr int size = TriangleTile::size;

 public:
  TileShading(const GBufferDrawJob& job, int left, int top)
      : job_(job),
        shading_(job.frame, job.scene, job.deforms),
        tile_(left, top),
        left_(left),
        top_(top),
        width_(std::min(size, job.width - left)),
        height_(std::min(size, job.height - top)) {}

  void run() {
    const bool passing = tile_.draw(job_.triangles);
    if (job_.blended) begin_blended();
    const int lanes = static_cast<int>(hn::Lanes(tag));
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; x += lanes) {
        nearest(x, y, std::min(lanes, width_ - x), passing);
      }
    }
    while (passed_count_ > 0) next_layer();
    if (job_.blended) end_blended(passing);
  }

 private:
  /// Of `count` pixels from (x, y) of the tile on.
  void nearest(int x, int y, int count, bool passing) {
    const PixelLanes pixel{hn::Iota(integer_tag, left_ + x), integer(top_ + y)};
    const auto number_of = static_cast<std::size_t>(y * size + x);
    const Mask requested = hn::FirstN(tag, static_cast<std::size_t>(count));
    HitLanes hit = hits(tile_.instances(number_of), tile_.triangles(number_of), requested);
    if (none(hit.met)) {
      store(empty_texels<AllTexels>(), pixel, requested);
      return;
    }
    HitRecords records(job_.scene, hit);
    const RayLanes ray = camera_rays(job_.frame, shading_.camera(), pixel);
    meet(records, ray, hit);
    const Surface s = shading_.surface(records, hit, ray.direction);
    if (passing) {
      const Integer numbers_of = hn::Iota(integer_tag, y * size + x);
      const Mask passes = let_pass(pixel, numbers_of, records, hit, s, ray.direction);
      keep(numbers_of, passes);
      // What lies behind is stored in the round that finds it.
      if (hn::CountTrue(tag, passes) == static_cast<std::size_t>(count)) return;
    }
    store(choose(hit.met, shading_.texels(pixel, records, hit, s), empty_texels<AllTexels>()),
          pixel, requested);
  }

  /// Of the pixels that let rays pass: what is behind.
  void next_layer() {
    ++round_;
    tile_.draw_behind(job_.triangles);
    const int count = passed_count_;
    passed_count_ = 0;
    for (int i = 0; i < count; i += static_cast<int>(hn::Lanes(tag))) {
      const Mask requested = hn::FirstN(tag, static_cast<std::size_t>(count - i));
      const Integer numbers_of = hn::IfThenElseZero(
          integer_mask(requested), hn::LoadU(integer_tag, &passed_[static_cast<std::size_t>(i)]));
      behind(numbers_of, requested);
    }
  }

  void behind(Integer numbers_of, Mask requested) {
    static_assert(size == 32);
    const PixelLanes pixel{hn::Add(integer(left_), hn::And(numbers_of, integer(size - 1))),
                           hn::Add(integer(top_), hn::ShiftRight<5>(numbers_of))};
    HitLanes hit = hits(tile_.instances_at(numbers_of), tile_.triangles_at(numbers_of), requested);
    const Mask missed = hn::AndNot(hit.met, requested);
    if (!none(missed)) store_texels(job_, empty_texels<AllTexels>(), pixel, missed);
    for_each_lane(missed, [&](std::size_t lane) { tile_.stop(number_in(numbers_of, lane)); });
    if (none(hit.met)) return;
    HitRecords records(job_.scene, hit);
    const RayLanes ray = camera_rays(job_.frame, shading_.camera(), pixel);
    meet(records, ray, hit);
    const Surface s = shading_.surface(records, hit, ray.direction);
    Mask passes = hn::Lt(one(), zero());
    if (round_ < job_.rounds) {
      passes = let_pass(pixel, numbers_of, records, hit, s, ray.direction);
      keep(numbers_of, passes);
    }
    const Mask stays = hn::AndNot(passes, hit.met);
    if (none(stays)) return;
    for_each_lane(stays, [&](std::size_t lane) { tile_.stop(number_in(numbers_of, lane)); });
    store_texels(job_, shading_.texels(pixel, records, hit, s), pixel, stays);
  }

  static HWY_INLINE std::size_t number_in(Integer numbers_of, std::size_t lane) {
    return static_cast<std::size_t>(hn::ExtractLane(numbers_of, lane));
  }

  static HWY_INLINE HitLanes hits(Integer instance, Integer triangle, Mask requested) {
    HitLanes hit;
    hit.met = hn::AndNot(float_mask(hn::Eq(instance, integer(static_cast<int>(shared::hit_none)))),
                         requested);
    if (none(hit.met)) return hit;
    const auto one_met = static_cast<std::size_t>(hn::FindFirstTrue(tag, hit.met));
    hit.instance = select(hit.met, instance, integer(hn::ExtractLane(instance, one_met)));
    hit.triangle = select(hit.met, triangle, integer(hn::ExtractLane(triangle, one_met)));
    return hit;
  }

  /// Whether the surfaces let rays pass; blended ones are laid over those in front.
  HWY_NOINLINE Mask let_pass(const PixelLanes& pixel, Integer numbers_of, const HitRecords& records,
                             const HitLanes& hit, const Surface& s, const Float3& direction) {
    const Mask open = hn::And(hit.met, is_open(s, direction));
    const Mask blended = hn::AndNot(open, hn::And(hit.met, is_blended(s)));
    if (job_.blended && round_ <= job_.blended_rounds && !none(blended)) {
      const BlendedLayer<Surface> layer(job_.frame, *job_.blended,
                                        {job_.blended_radiance, job_.blended_transmittance,
                                         job_.blended_motion, job_.blended_chosen},
                                        shading_, round_ - 1);
      const Mask seen = hn::And(blended, layer.shows_behind(pixel));
      if (!none(seen)) {
        const Mask front = layer.lay_over(pixel, records, hit, s, direction, seen).front;
        for_each_lane(front, [&](std::size_t lane) { fronts_[number_in(numbers_of, lane)] = 1; });
      }
    }
    return hn::Or(open, blended);
  }

  /// Lists pixels for the next layer.
  HWY_INLINE void keep(Integer numbers_of, Mask passes) {
    if (none(passes)) return;
    for_each_lane(passes, [&](std::size_t lane) { tile_.pass(number_in(numbers_of, lane)); });
    passed_count_ +=
        static_cast<int>(hn::CompressStore(numbers_of, integer_mask(passes), integer_tag,
                                           &passed_[static_cast<std::size_t>(passed_count_)]));
  }

  void begin_blended() {
    fronts_.fill(0);
    const auto width = static_cast<std::size_t>(width_);
    for (int y = top_; y < top_ + height_; ++y) {
      std::fill_n(row_of<float>(job_.blended_radiance, y) + 4 * left_, 4 * width, 0.0f);
      std::fill_n(row_of<glm::vec4>(job_.blended_transmittance, y) + left_, width,
                  glm::vec4(1.0f, 1.0f, 1.0f, 0.0f));
      std::fill_n(row_of<std::uint32_t>(job_.blended_surface, y) + left_, width, 0u);
      std::fill_n(row_of<float>(job_.blended_specular, y) + 4 * left_, 4 * width, 0.0f);
    }
  }

  /// Pixels without a blended surface in front move as the G-buffer's.
  void end_blended(bool passing) {
    for (int y = 0; y < height_; ++y) {
      const auto* const from = row_of<const glm::vec4>(job_.motion, top_ + y) + left_;
      auto* const to = row_of<glm::vec4>(job_.blended_motion, top_ + y) + left_;
      if (!passing) {
        std::copy_n(from, width_, to);
        continue;
      }
      for (int x = 0; x < width_; ++x) {
        if (!fronts_[static_cast<std::size_t>(y * size + x)]) to[x] = from[x];
      }
    }
  }

  /// Where the rays meet the planes of their triangles (Möller and Trumbore 1997), kept within
  /// them: a sample on an edge may lie beside the triangle by a fraction of a pixel.
  static HWY_INLINE void meet(HitRecords& records, const RayLanes& ray, HitLanes& hit) {
    const TriangleLanes& t = records.triangle;
    const Float3 a = records.world.point(t.a().position);
    const Float3 ab = records.world.direction(t.b().position - t.a().position);
    const Float3 ac = records.world.direction(t.c().position - t.a().position);
    const Float3 p = cross(ray.direction, ac);
    const Float determinant = dot(ab, p);
    const Mask edge_on = hn::Eq(determinant, zero());
    const Float scale = hn::IfThenZeroElse(edge_on, one() / select(edge_on, one(), determinant));
    hit.u = hit.v = hit.t = zero();
    // Twice: long, thin triangles lose half of the digits, which the distance that is left between
    // point and ray tells.
    Float3 at = a;
    for (int i = 0; i < 2; ++i) {
      const Float3 off = multiply_add(ray.direction, hit.t, ray.origin) - at;
      const Float u = hit.u + dot(off, p) * scale;
      const Float v = hit.v + dot(ray.direction, cross(off, ab)) * scale;
      hit.u = hn::IfThenElseZero(hit.met, clamped(u, 0.0f, 1.0f));
      hit.v = hn::IfThenElseZero(hit.met, hn::Min(clamped(v, 0.0f, 1.0f), one() - hit.u));
      at = multiply_add(ab, hit.u, multiply_add(ac, hit.v, a));
      hit.t = dot(at - ray.origin, ray.direction);
    }
    hit.t = select(hit.met, hit.t, one());
    records.triangle.set_point(hit.u, hit.v);
  }

  static HWY_INLINE AllTexels choose(Mask first, const AllTexels& a, const AllTexels& b) {
    if (all(first)) return a;
    const auto pair = [first](const Float2& x, const Float2& y) HWY_ATTR {
      return Float2{select(first, x.x, y.x), select(first, x.y, y.y)};
    };
    AllTexels to;
    to.normals = select(first, a.normals, b.normals);
    to.motion = select(first, a.motion, b.motion);
    to.depth_slope = pair(a.depth_slope, b.depth_slope);
    to.emissive = pair(a.emissive, b.emissive);
    to.base_color = select(first, a.base_color, b.base_color);
    to.surface = select(first, a.surface, b.surface);
    to.instance = select(first, a.instance, b.instance);
    if constexpr (Surface::layered) to.layers = select(first, a.layers, b.layers);
    return to;
  }

  /// Pixels side by side, of which the first are requested.
  HWY_NOINLINE void store(const AllTexels& texels, const PixelLanes& pixel, Mask requested) {
    const int x = hn::GetLane(pixel.x), y = hn::GetLane(pixel.y);
    const std::size_t count = hn::CountTrue(tag, requested);
    const bool whole = count == hn::Lanes(tag);
    const auto put = [&](const gpu::HostView& image, const auto& value, int words) HWY_ATTR {
      float* const to = row_of<float>(image, y) + words * x;
      if (whole) {
        interleave(value, to);
        return;
      }
      HWY_ALIGN std::array<float, 4 * hn::MaxLanes(Tag())> row;
      interleave(value, row.data());
      std::memcpy(to, row.data(), count * static_cast<std::size_t>(words) * sizeof(float));
    };
    put(job_.normals, texels.normals, 4);
    put(job_.motion, texels.motion, 4);
    put(job_.depth_slope, texels.depth_slope, 2);
    put(job_.emissive, texels.emissive, 2);
    put(job_.base_color, texels.base_color, 1);
    put(job_.surface, texels.surface, 1);
    put(job_.instance, texels.instance, 1);
    if constexpr (Surface::layered) put(job_.layers, texels.layers, 4);
  }
  static HWY_INLINE void interleave(Float v, float* to) { hn::StoreU(v, tag, to); }
  static HWY_INLINE void interleave(const Float2& v, float* to) {
    hn::StoreInterleaved2(v.x, v.y, tag, to);
  }
  static HWY_INLINE void interleave(const Float4& v, float* to) { store4(tag, v, to); }

  const GBufferDrawJob& job_;
  Shading shading_;
  TriangleTile tile_;
  int left_, top_, width_, height_;
  std::uint32_t round_ = 1;
  // Pixels whose rays go on, counted as the tile counts them; with room for a whole vector.
  HWY_ALIGN std::array<int, TriangleTile::pixels + hn::MaxLanes(Tag())> passed_;
  int passed_count_ = 0;
  std::array<std::uint8_t, TriangleTile::pixels> fronts_;  // 1: moves as a blended surface
};

void draw_tile(const GBufferDrawJob& job, int left, int top) {
  if (job.layers) return TileShading<LayeredSurfaceLanes>(job, left, top).run();
  TileShading<SurfaceLanes>(job, left, top).run();
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(draw_tile);

void gbuffer_draw(const GBufferDrawJob& job) {
  constexpr int size = triangle_tile;
  const int across = (job.width + size - 1) / size, down = (job.height + size - 1) / size;
  for_each_range(across * down, 1, [&](int first, int last) {
    for (int i = first; i < last && !job.plan.is_canceled(); ++i) {
      HWY_DYNAMIC_DISPATCH(draw_tile)(job, i % across * size, i / across * size);
    }
  });
}

}  // namespace heliograph::render::kernels
#endif
