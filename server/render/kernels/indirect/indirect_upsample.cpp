#include "render/kernels/indirect/indirect_half.hpp"
#include "render/kernels/simd/rows.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/indirect/indirect_upsample.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/simd/denoise/half_rows.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// Lanes are pixels side by side.
template <class D>
class IndirectUpsampling {
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;

  struct Sums {
    Quad<V> value;
    V total;
  };

 public:
  HWY_INLINE explicit IndirectUpsampling(const IndirectUpsampleJob& job) : job_(job) {}

  HWY_INLINE void rows(int first, int last) const {
    const int lanes = static_cast<int>(hn::Lanes(d_));
    const glm::ivec2 half_size{(job_.width + 1) / 2, (job_.height + 1) / 2};
    HalfRows<D> halves(job_.half_guide, job_.half_signal, half_size, (first - 1) >> 1);
    for (int y = first; y < last; ++y) {
      halves.advance((y + 1) >> 1);
      const ViewedRow<D> view(job_.frame, y);
      for (int x = 0; x < job_.width; x += lanes) {
        block(halves, view, std::min(x, job_.width - lanes), y);
      }
    }
  }

 private:
  HWY_INLINE V set(float value) const { return hn::Set(d_, value); }

  HWY_INLINE void block(const HalfRows<D>& halves, const ViewedRow<D>& view, int x, int y) const {
    const V zero = hn::Zero(d_);
    const Quad<V> guide = load4(d_, row_of<const float>(job_.guide, y) + 4 * x);
    const M seen = guide_is_surface(guide);
    Quad<V> denoised{zero, zero, zero, zero};
    if (!hn::AllFalse(d_, seen)) {
      const Guide<V> p = decode_guide(guide);
      const Pair<V> slope = load2(d_, row_of<const float>(job_.depth_slope, y) + 2 * x);
      const HalfWeights<D> weights(p.normal, surface_plane(view, p.view_z, slope),
                                   job_.constants.normal_power, job_.constants.depth_sigma);
      Sums sums{denoised, zero};
      for (int side = -1; side <= 1; side += 2) {
        const int row = (y + side) >> 1;
        if (!halves.has(row)) continue;
        const float dy = static_cast<float>(2 * row - y), near = row == y >> 1 ? 0.75f : 0.25f;
        const float* const texels = halves.row(row) + x;
        add_texel(weights, halves, texels - 1, half_column(d_, x, -1), dy, near, sums);
        add_texel(weights, halves, texels + 1, half_column(d_, x, 1), dy, near, sums);
      }
      const V inverse =
          hn::IfThenElseZero(seen, reciprocal(hn::Max(sums.total, set(shared::upsample_least))));
      denoised = {sums.value.x * inverse, sums.value.y * inverse, sums.value.z * inverse,
                  sums.value.w * (inverse * inverse)};
    }
    store4(d_, denoised, row_of<float>(job_.denoised, y) + 4 * x);
  }

  HWY_INLINE void add_texel(const HalfWeights<D>& weights, const HalfRows<D>& halves,
                            const float* texels, const HalfColumn<V>& column, float dy,
                            float nearness_down, Sums& sums) const {
    using Half = HalfRows<D>;
    const V z = halves.load(texels, Half::view_z);
    const M valid = hn::Gt(z, hn::Zero(d_));
    const V of_surface = edge_weight(valid, weights.exponent(halves, texels, z, column, dy));
    const V nearness = column.nearness * set(nearness_down);
    const V weight =
        nearness * hn::IfThenElseZero(valid, hn::Max(of_surface, set(shared::upsample_least)));
    sums.value.x = hn::MulAdd(weight, halves.load(texels, Half::signal), sums.value.x);
    sums.value.y = hn::MulAdd(weight, halves.load(texels, Half::signal + 1), sums.value.y);
    sums.value.z = hn::MulAdd(weight, halves.load(texels, Half::signal + 2), sums.value.z);
    sums.value.w = hn::MulAdd(weight * weight, halves.load(texels, Half::signal + 3), sums.value.w);
    sums.total = sums.total + weight;
  }

  const D d_{};
  const IndirectUpsampleJob& job_;
};

/// Vectors are as wide as fits into a row of half size.
void indirect_upsample_rows(const IndirectUpsampleJob& job, int first, int last) {
  run_rows<IndirectUpsampling>(job, (job.width + 1) / 2, first, last);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(indirect_upsample_rows);

void indirect_upsample(const IndirectUpsampleJob& job) {
  constexpr int band = 32;  // rows of half size above and below it are read twice
  for_each_range(job.height, band, [&](int first, int last) {
    HWY_DYNAMIC_DISPATCH(indirect_upsample_rows)(job, first, last);
  });
}

}  // namespace heliograph::render::kernels
#endif
