#include "render/kernels/gbuffer/gbuffer_draw.hpp"

#include "render/kernels/simd/rows.hpp"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/gbuffer/gbuffer_draw.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/gbuffer/gbuffer_shading.hpp"
#include "render/kernels/gbuffer/triangle_tile.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// `Surface`: SurfaceLanes, or LayeredSurfaceLanes.
template <class Surface>
class TileShading {
  using Shading = GBufferShading<Surface>;
  using AllTexels = TexelsOf<Surface>;

 public:
  TileShading(const GBufferDrawJob& job, int left, int top)
      : job_(job),
        shading_(job.frame, job.scene, job.deforms),
        tile_(left, top),
        left_(left),
        top_(top) {}

  void run() {
    tile_.draw(job_.triangles);
    const int lanes = static_cast<int>(hn::Lanes(tag));
    const int width = std::min(TriangleTile::size, job_.width - left_);
    const int height = std::min(TriangleTile::size, job_.height - top_);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; x += lanes) block(x, y, std::min(lanes, width - x));
      if (used_ > passed_.size() - TriangleTile::size) flush();
    }
    flush();
  }

 private:
  /// Of `count` pixels from (x, y) of the tile on.
  void block(int x, int y, int count) {
    const PixelLanes pixel{hn::Iota(integer_tag, left_ + x), integer(top_ + y)};
    const Mask requested = hn::FirstN(tag, static_cast<std::size_t>(count));
    HitLanes hit;
    hit.instance = tile_.instance(x, y);
    hit.met = hn::AndNot(
        float_mask(hn::Eq(hit.instance, integer(static_cast<int>(shared::hit_none)))), requested);
    if (none(hit.met)) {
      store(empty_texels<AllTexels>(), pixel, requested);
      return;
    }
    const auto one_met = static_cast<std::size_t>(hn::FindFirstTrue(tag, hit.met));
    hit.instance = select(hit.met, hit.instance, integer(hn::ExtractLane(hit.instance, one_met)));
    hit.triangle = tile_.triangle(x, y);
    hit.triangle = select(hit.met, hit.triangle, integer(hn::ExtractLane(hit.triangle, one_met)));
    HitRecords records(job_.scene, hit);
    RayLanes ray = camera_rays(job_.frame, shading_.camera(), pixel);
    meet(records, ray, hit);
    const Surface s = shading_.surface(records, hit, ray.direction);
    // What is stored where rays go on is stored again in the round that stops them.
    store(choose(hit.met, shading_.texels(pixel, records, hit, s), empty_texels<AllTexels>()),
          pixel, requested);
    const Mask passes = shading_.go_on(ray.direction, hit, s);
    if (none(passes)) return;
    ray.t_min = Shading::passed_from(hit.t);
    used_ += store_rays(ray, passes, passed_.data() + used_);
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

  void flush() {
    if (used_) job_.passed.append({passed_.data(), used_});
    used_ = 0;
  }

  const GBufferDrawJob& job_;
  Shading shading_;
  TriangleTile tile_;
  int left_, top_;
  std::array<shared::Ray, 8 * TriangleTile::size> passed_;
  std::size_t used_ = 0;
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
    for (int i = first; i < last; ++i) {
      HWY_DYNAMIC_DISPATCH(draw_tile)(job, i % across * size, i / across * size);
    }
  });
  job.passed.end();
}

}  // namespace heliograph::render::kernels
#endif
