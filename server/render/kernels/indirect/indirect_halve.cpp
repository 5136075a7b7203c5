#include "render/kernels/indirect/indirect_half.hpp"
#include "render/kernels/simd/rows.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/indirect/indirect_halve.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/simd/denoise/pixel_pairs.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// Lanes are squares side by side.
template <class D>
class IndirectHalving {
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;

  /// Those of the squares, from their first pixels that show any.
  struct Surfaces {
    Quad<V> normals;
    Quad<V> motion;
    Pair<V> slope;
    V instance;
    M known;
  };
  struct Samples {
    Triple<V> sum;
    V count;
  };

 public:
  HWY_INLINE explicit IndirectHalving(const IndirectHalveJob& job)
      : job_(job), half_width_((job.width + 1) / 2) {}

  HWY_INLINE void rows(int first, int last) const {
    const int lanes = static_cast<int>(hn::Lanes(d_));
    for (int y = first; y < last; ++y) {
      for (int x = 0; x < half_width_; x += lanes) block(std::min(x, half_width_ - lanes), y);
    }
  }

 private:
  HWY_INLINE V set(float value) const { return hn::Set(d_, value); }

  HWY_INLINE void block(int x, int y) const {
    const V zero = hn::Zero(d_);
    const Quad<V> nothing{zero, zero, zero, zero};
    Surfaces surfaces{nothing, nothing, {zero, zero}, zero, hn::Gt(zero, zero)};
    Samples samples{{zero, zero, zero}, zero};
    for (int row = 0; row < 2 && 2 * y + row < job_.height; ++row) {
      const PixelPairs<D> pixels(job_.width, x, 2 * y + row);
      const auto normals = pixels.four(job_.normals), motion = pixels.four(job_.motion);
      const auto radiance = pixels.four(job_.radiance);
      const auto slope = pixels.two(job_.depth_slope);
      const auto instance = pixels.one(job_.instance);
      for (std::size_t i = 0; i < 2; ++i) {
        const M seen = hn::Gt(motion[i].w, zero);
        find({normals[i], motion[i], slope[i], instance[i], seen}, surfaces);
        const M same = hn::And(seen, is_same(surfaces, normals[i], motion[i].w, instance[i]));
        add(radiance[i], same, samples);
      }
    }
    store(surfaces, samples, x, y);
  }

  HWY_INLINE void find(const Surfaces& pixel, Surfaces& surfaces) const {
    const M begins = hn::AndNot(surfaces.known, pixel.known);
    surfaces.normals = select(begins, pixel.normals, surfaces.normals);
    surfaces.motion = select(begins, pixel.motion, surfaces.motion);
    surfaces.slope = {hn::IfThenElse(begins, pixel.slope.x, surfaces.slope.x),
                      hn::IfThenElse(begins, pixel.slope.y, surfaces.slope.y)};
    surfaces.instance = hn::IfThenElse(begins, pixel.instance, surfaces.instance);
    surfaces.known = hn::Or(surfaces.known, pixel.known);
  }

  HWY_INLINE M is_same(const Surfaces& s, const Quad<V>& normals, V view_z, V instance) const {
    const hn::RebindToSigned<D> di;
    const M one =
        hn::RebindMask(d_, hn::Eq(hn::BitCast(di, instance), hn::BitCast(di, s.instance)));
    const V cosine =
        dot(octahedral_decode(s.normals.x, s.normals.y), octahedral_decode(normals.x, normals.y));
    const V allowed =
        hn::MulAdd(set(shared::half_size_depth), s.motion.w,
                   set(shared::half_size_slopes) * (hn::Abs(s.slope.x) + hn::Abs(s.slope.y)));
    const M near = hn::Le(hn::Abs(view_z - s.motion.w), allowed);
    return hn::And(one, hn::And(near, hn::Gt(cosine, set(shared::half_size_cosine))));
  }

  HWY_INLINE void add(const Quad<V>& radiance, M same, Samples& samples) const {
    const Triple<V> light{radiance.x, radiance.y, radiance.z};
    const M taken = hn::And(same, hn::Ge(radiance.w, hn::Zero(d_)));
    samples.sum = {samples.sum.x + hn::IfThenElseZero(taken, light.x),
                   samples.sum.y + hn::IfThenElseZero(taken, light.y),
                   samples.sum.z + hn::IfThenElseZero(taken, light.z)};
    samples.count = samples.count + hn::IfThenElseZero(taken, set(1.0f));
  }

  HWY_INLINE void store(const Surfaces& s, const Samples& samples, int x, int y) const {
    const V one = set(1.0f);
    const V inverse = one / hn::Max(samples.count, one);
    const M sampled = hn::Gt(samples.count, hn::Zero(d_));
    store4(d_, s.normals, row_of<float>(job_.half_normals, y) + 4 * x);
    store4(d_, s.motion, row_of<float>(job_.half_motion, y) + 4 * x);
    hn::StoreInterleaved2(s.slope.x + s.slope.x, s.slope.y + s.slope.y, d_,
                          row_of<float>(job_.half_slope, y) + 2 * x);
    hn::StoreU(s.instance, d_, row_of<float>(job_.half_instance, y) + x);
    const hn::RebindToUnsigned<D> du;
    hn::StoreU(hn::Set(du, 0xffu), du, row_of<std::uint32_t>(job_.half_surface, y) + x);
    store4(d_,
           {samples.sum.x * inverse, samples.sum.y * inverse, samples.sum.z * inverse,
            hn::IfThenElse(sampled, one, set(-1.0f))},
           row_of<float>(job_.half_radiance, y) + 4 * x);
  }

  const D d_{};
  const IndirectHalveJob& job_;
  int half_width_;
};

void indirect_halve_rows(const IndirectHalveJob& job, int first, int last) {
  run_rows<IndirectHalving>(job, (job.width + 1) / 2, first, last);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(indirect_halve_rows);

void indirect_halve(const IndirectHalveJob& job) {
  for_each_band((job.height + 1) / 2, [&](int first, int last) {
    HWY_DYNAMIC_DISPATCH(indirect_halve_rows)(job, first, last);
  });
}

}  // namespace heliograph::render::kernels
#endif
