#include "render/kernels/visibility_rays.hpp"

#include "render/kernels/common/ray_sink.hpp"
#include "render/kernels/simd/rows.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/visibility_rays.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/simd/material.hpp"
#include "render/kernels/simd/random.hpp"
#include "render/kernels/simd/rays.hpp"
#include "render/kernels/simd/view.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// What both kinds of rays have in common: how they traverse the frame and append rays.
/// Neighbours in the stream are neighbours in the frame across and down.
template <class D, class Maker>
class VisibilityRays {
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;

 public:
  template <class Job>
  HWY_INLINE void generate(const Job& job, int first, int last) const {
    const D d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    RayBatch batch(*job.rays.count, job.rays.rays,
                   static_cast<std::size_t>(job.width) * static_cast<std::size_t>(last - first));
    for (int start = 0; start < job.width; start += lanes) {
      const int x = std::min(start, job.width - lanes);
      for (int y = first; y < last; ++y) {
        const V view_z = load4(d, row_of<const float>(job.motion, y) + 4 * x).w;
        const M seen = hn::Gt(view_z, hn::Zero(d));
        M requested = seen;
        if (!hn::AllFalse(d, seen)) {
          Triple<V> origin, direction;
          V t_max;
          static_cast<const Maker*>(this)->make(x, y, view_z, requested, origin, direction, t_max);
          batch.add(d, origin, direction, t_max, x, y,
                    hn::And(requested, from_column(d, x, start)));
        }
        const V open = static_cast<const Maker*>(this)->untraced(seen, requested);
        hn::StoreU(open, d, row_of<float>(job.visibility, y) + x);
      }
    }
    batch.flush();
  }
};

template <class D>
class ShadowRays : public VisibilityRays<D, ShadowRays<D>> {
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;
  using DU = hn::RebindToUnsigned<D>;

 public:
  HWY_INLINE explicit ShadowRays(const ShadowRaysJob& job)
      : job_(job),
        split_sum_(job.split_sum.texels, job.split_sum.size),
        picks_(DU(), job.frame.sample_index, 1u, job.frame.seed),
        points_(DU(), job.frame.sample_index, 2u, job.frame.seed) {}

  HWY_INLINE void rows(int first, int last) const { this->generate(job_, first, last); }

  HWY_INLINE void make(int x, int y, V view_z, M& requested, Triple<V>& origin,
                       Triple<V>& direction, V& t_max) const {
    const ViewedRow<D> view(job_.frame, y);
    const auto m = material(view, x, y);
    const Triple<V> position = view.world_position(x, view_z);
    const auto column = hn::Iota(DU(), static_cast<std::uint32_t>(x));
    const auto row = hn::Set(DU(), static_cast<std::uint32_t>(y));
    V pick = picks_.at(column, row);
    V total = hn::Zero(d_), spread = total;
    t_max = total;
    direction = {total, total, total};
    for (const shared::Light& light : job_.lights) {
      Triple<V> radiance;
      if (!light_contribution(d_, light, m, position, requested, radiance)) continue;
      const M chosen = take(luminance(radiance), total, pick);
      if (hn::AllFalse(d_, chosen)) continue;
      const LightSample<V> s = light_at(d_, light, position);
      direction = select(chosen, s.direction, direction);
      t_max = hn::IfThenElse(chosen, s.distance, t_max);
      const bool endless = light.type == shared::light_directional;
      const V radius = hn::Set(d_, light.radius);
      spread = hn::IfThenElse(chosen, endless ? radius : radius / s.distance, spread);
    }
    requested = hn::And(requested, hn::Gt(total, hn::Zero(d_)));
    direction = toward_disk(direction, spread, column, row);
    requested = hn::And(requested, hn::Gt(dot(direction, m.geometric), hn::Zero(d_)));
    origin = offset_origin(position, m.geometric, view_z);
    // Geometry may lie where a light does and show it: it must not occlude itself.
    t_max = t_max * hn::Set(d_, 0.999f);
  }

  HWY_INLINE V untraced(M, M requested) const {
    return hn::IfThenElseZero(requested, hn::Set(d_, 1.0f));
  }

 private:
  HWY_INLINE SurfaceMaterial<V> material(const ViewedRow<D>& view, int x, int y) const {
    const Quad<V> encoded = load4(d_, row_of<const float>(job_.normals, y) + 4 * x);
    const Quad<V> root = load_unorm8(d_, row_of<const std::uint32_t>(job_.base_color, y) + x);
    const Quad<V> packed = load_unorm8(d_, row_of<const std::uint32_t>(job_.surface, y) + x);
    const Triple<V> color{root.x * root.x, root.y * root.y, root.z * root.z};
    return make_material(d_, color, packed.y, packed.x, octahedral_decode(encoded.x, encoded.y),
                         octahedral_decode(encoded.z, encoded.w), view.to_eye(x), split_sum_);
  }

  /// takes() of shaders/lib/lighting/light_choice.glsl
  HWY_INLINE M take(V weight, V& total, V& pick) const {
    const V one = hn::Set(d_, 1.0f);
    const M valid = hn::Gt(weight, hn::Zero(d_));
    total = total + hn::IfThenElseZero(valid, weight);
    const V probability = weight / total;
    const M chosen = hn::And(valid, hn::Lt(pick, probability));
    const V left = hn::IfThenElse(valid, (pick - probability) / (one - probability), pick);
    pick = hn::IfThenElse(chosen, pick / probability, left);
    return chosen;
  }

  template <class VU>
  HWY_INLINE Triple<V> toward_disk(const Triple<V>& direction, V spread, VU column, VU row) const {
    V u, v;
    points_.at(column, row, u, v);
    Triple<V> tangent, bitangent;
    orthonormal_basis(direction, tangent, bitangent);
    const Pair<V> disk = sample_disk(u, v);
    return normalized(direction + tangent * (disk.x * spread) + bitangent * (disk.y * spread));
  }

  const D d_{};
  const ShadowRaysJob& job_;
  SquareTable<D> split_sum_;
  RandomNumbers<DU> picks_;
  RandomPairs<DU> points_;
};

template <class D>
class AmbientRays : public VisibilityRays<D, AmbientRays<D>> {
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;
  using DU = hn::RebindToUnsigned<D>;

 public:
  HWY_INLINE explicit AmbientRays(const AmbientRaysJob& job)
      : job_(job), directions_(DU(), job.frame.sample_index, 3u, job.frame.seed) {}

  HWY_INLINE void rows(int first, int last) const { this->generate(job_, first, last); }

  HWY_INLINE void make(int x, int y, V view_z, M& requested, Triple<V>& origin,
                       Triple<V>& direction, V& t_max) const {
    const Quad<V> encoded = load4(d_, row_of<const float>(job_.normals, y) + 4 * x);
    const Triple<V> geometric = octahedral_decode(encoded.z, encoded.w);
    V u, v;
    directions_.at(hn::Iota(DU(), static_cast<std::uint32_t>(x)),
                   hn::Set(DU(), static_cast<std::uint32_t>(y)), u, v);
    direction = sample_cosine(octahedral_decode(encoded.x, encoded.y), u, v);
    const ViewedRow<D> view(job_.frame, y);
    origin = offset_origin(view.world_position(x, view_z), geometric, view_z);
    t_max = hn::Set(d_, job_.frame.ambient_radius);
    requested = hn::And(requested, hn::Gt(dot(direction, geometric), hn::Zero(d_)));
  }

  /// Directions below the surface are hidden by it.
  HWY_INLINE V untraced(M seen, M requested) const {
    return hn::IfThenElseZero(hn::Or(requested, hn::Not(seen)), hn::Set(d_, 1.0f));
  }

 private:
  const D d_{};
  const AmbientRaysJob& job_;
  RandomPairs<DU> directions_;
};

void shadow_ray_rows(const ShadowRaysJob& job, int first, int last) {
  run_rows<ShadowRays>(job, job.width, first, last);
}

void ambient_ray_rows(const AmbientRaysJob& job, int first, int last) {
  run_rows<AmbientRays>(job, job.width, first, last);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(shadow_ray_rows);
HWY_EXPORT(ambient_ray_rows);

void shadows_rays(const ShadowRaysJob& job) {
  for_each_band(job.height, [&](int first, int last) {
    HWY_DYNAMIC_DISPATCH(shadow_ray_rows)(job, first, last);
  });
  job.rays.end();
}

void ambient_rays(const AmbientRaysJob& job) {
  for_each_band(job.height, [&](int first, int last) {
    HWY_DYNAMIC_DISPATCH(ambient_ray_rows)(job, first, last);
  });
  job.rays.end();
}

}  // namespace heliograph::render::kernels
#endif
