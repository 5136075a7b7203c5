#include "render/kernels/simd/rows.hpp"
#include "render/kernels/visibility_half.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/visibility_upsample.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/simd/denoise/half_rows.hpp"
#include "render/kernels/simd/denoise/surface_plane.hpp"
#include "render/kernels/simd/signal_rows.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// Lanes are pixels side by side.
template <class D>
class Upsampling {
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;
  using Rows = SignalRows<D, true>;

  /// All exponents count octaves.
  struct Center {
    HalfWeights<D> surface;
    V value[2];
    V inv_sigma[2];  // 1 / what a difference of visibility may be
  };
  struct Sums {
    Quad<V> value;
    V total[2];
  };

 public:
  HWY_INLINE explicit Upsampling(const VisibilityUpsampleJob& job) : job_(job), c_(job.constants) {}

  HWY_INLINE void rows(int first, int last) const {
    const int lanes = static_cast<int>(hn::Lanes(d_));
    Rows rows(job_.guide, job_.signal, job_.width, job_.height,
              Area{0, job_.width, std::max(first - 1, 0), last}, RowReach{1, 1, 1});
    HalfRows<D> halves(job_.half_guide, job_.half_signal, half_size(), (first - 1) >> 1);
    for (int y = first; y < last; ++y) {
      rows.advance(y);
      halves.advance((y + 1) >> 1);
      if (prefilters()) rows.add_variance_rows(Rows::signal, 0, job_.width, y);
      const ViewedRow<D> view(job_.frame, y);
      for (int x = 0; x < job_.width; x += lanes) {
        block(rows, halves, view, std::min(x, job_.width - lanes), y);
      }
    }
  }

 private:
  HWY_INLINE V set(float value) const { return hn::Set(d_, value); }
  glm::ivec2 half_size() const { return {(job_.width + 1) / 2, (job_.height + 1) / 2}; }
  bool prefilters() const { return (c_.flags & shared::atrous_variance_prefilter) != 0; }

  HWY_INLINE void block(const Rows& rows, const HalfRows<D>& halves, const ViewedRow<D>& view,
                        int x, int y) const {
    const float* const texels = rows.row(y) + x;
    const Quad<V> value{rows.load(texels, Rows::signal), rows.load(texels, Rows::signal + 1),
                        rows.load(texels, Rows::signal + 2), rows.load(texels, Rows::signal + 3)};
    const M seen = hn::Gt(rows.load(texels, Rows::view_z), hn::Zero(d_));
    Quad<V> denoised = value;
    if (!hn::AllFalse(d_, seen)) {
      const Center c = center(rows, view, value, x, y);
      const V own = set(shared::upsample_own_weight), square = own * own;
      Sums sums{{own * value.x, own * value.y, square * value.z, square * value.w}, {own, own}};
      for (int side = -1; side <= 1; side += 2) {
        const int row = (y + side) >> 1;
        if (!halves.has(row)) continue;
        const float dy = static_cast<float>(2 * row - y), near = row == y >> 1 ? 0.75f : 0.25f;
        add_texel(c, halves, halves.row(row) + x - 1, half_column(d_, x, -1), dy, near, sums);
        add_texel(c, halves, halves.row(row) + x + 1, half_column(d_, x, 1), dy, near, sums);
      }
      denoised = select(seen, result(sums), value);
    }
    store4(d_, denoised, row_of<float>(job_.denoised, y) + 4 * x);
  }

  HWY_INLINE Center center(const Rows& rows, const ViewedRow<D>& view, const Quad<V>& value, int x,
                           int y) const {
    const float* const texels = rows.row(y) + x;
    const Triple<V> normal{rows.load(texels, Rows::normal_x), rows.load(texels, Rows::normal_y),
                           rows.load(texels, Rows::normal_z)};
    const auto plane = surface_plane(view, rows.load(texels, Rows::view_z),
                                     load2(d_, row_of<const float>(job_.depth_slope, y) + 2 * x));
    Center c{{normal, plane, c_.normal_power, c_.depth_sigma}, {}, {}};
    c.value[0] = value.x;
    c.value[1] = value.y;
    for (int i = 0; i < 2; ++i) {
      const V variance = prefilters() ? rows.smooth_variance(x, i) : (i == 0 ? value.z : value.w);
      const V allowed = hn::MulAdd(set(c_.luminance_sigma / octaves),
                                   hn::Sqrt(hn::Max(variance, hn::Zero(d_))), set(1e-3f / octaves));
      c.inv_sigma[i] = hn::ApproximateReciprocal(allowed);
    }
    return c;
  }

  HWY_INLINE void add_texel(const Center& c, const HalfRows<D>& halves, const float* texels,
                            const HalfColumn<V>& column, float dy, float nearness_down,
                            Sums& sums) const {
    using Half = HalfRows<D>;
    const V z = halves.load(texels, Half::view_z);
    const M valid = hn::Gt(z, hn::Zero(d_));
    const V exponent = c.surface.exponent(halves, texels, z, column, dy);
    const V nearness = column.nearness * set(nearness_down);
    for (int i = 0; i < 2; ++i) {
      const V value = halves.load(texels, Half::signal + i);
      const V differs = hn::Abs(value - c.value[i]);
      const V weight =
          nearness * edge_weight(valid, hn::NegMulAdd(differs, c.inv_sigma[i], exponent));
      add(i == 0 ? sums.value.x : sums.value.y, weight, value);
      add(i == 0 ? sums.value.z : sums.value.w, weight * weight,
          halves.load(texels, Half::signal + 2 + i));
      sums.total[i] = sums.total[i] + weight;
    }
  }
  HWY_INLINE void add(V& sum, V weight, V value) const { sum = hn::MulAdd(weight, value, sum); }

  HWY_INLINE Quad<V> result(const Sums& sums) const {
    const V by_x = reciprocal(sums.total[0]), by_y = reciprocal(sums.total[1]);
    return {sums.value.x * by_x, sums.value.y * by_y, sums.value.z * (by_x * by_x),
            sums.value.w * (by_y * by_y)};
  }

  const D d_{};
  const VisibilityUpsampleJob& job_;
  const shared::AtrousConstants& c_;
};

/// Vectors are as wide as fits into a row of half size.
void upsample_rows(const VisibilityUpsampleJob& job, int first, int last) {
  run_rows<Upsampling>(job, (job.width + 1) / 2, first, last);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(upsample_rows);

void visibility_upsample(const VisibilityUpsampleJob& job) {
  constexpr int band = 32;  // rows above and below it are read twice
  for_each_range(job.height, band, [&](int first, int last) {
    HWY_DYNAMIC_DISPATCH(upsample_rows)(job, first, last);
  });
}

}  // namespace heliograph::render::kernels
#endif
