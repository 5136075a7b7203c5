#include "render/kernels/simd/rows.hpp"
#include "render/kernels/visibility_half.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/visibility_upsample.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/simd/denoise/surface_plane.hpp"
#include "render/kernels/simd/guide.hpp"
#include "render/kernels/simd/signal_rows.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// Rows of texels of half size in planes, every texel twice: the two about a pixel lie one column
/// before it and one behind it.
template <class D>
class HalfRows {
  using V = hn::Vec<D>;

 public:
  enum Plane { normal_x, normal_y, normal_z, view_z, signal, planes = signal + 4 };

  HalfRows(const VisibilityUpsampleJob& job, int first)
      : job_(job),
        width_((job.width + 1) / 2),
        height_((job.height + 1) / 2),
        next_(std::max(first, 0)),
        ring_(planes, 2 * width_, 1, 2) {}

  HWY_INLINE void advance(int last) {
    for (; next_ <= std::min(last, height_ - 1); ++next_) fill(next_);
  }
  bool has(int y) const { return y >= 0 && y < height_; }
  HWY_INLINE const float* row(int y) const { return ring_.row(y); }
  HWY_INLINE V load(const float* texels, int plane) const {
    return hn::LoadU(d_, texels + plane * ring_.pitch());
  }

 private:
  HWY_INLINE void fill(int y) const {
    const int lanes = static_cast<int>(hn::Lanes(d_));
    const float* const guide = row_of<const float>(job_.half_guide, y);
    const float* const from = row_of<const float>(job_.half_signal, y);
    for (int start = 0; start < width_; start += lanes) {
      const int x = std::min(start, width_ - lanes);
      float* const to = ring_.row(y) + 2 * x;
      const auto surface = decode_guide(load4(d_, guide + 4 * x));
      const Quad<V> value = load4(d_, from + 4 * x);
      store_twice(surface.normal.x, to, normal_x);
      store_twice(surface.normal.y, to, normal_y);
      store_twice(surface.normal.z, to, normal_z);
      store_twice(surface.view_z, to, view_z);
      store_twice(value.x, to, signal);
      store_twice(value.y, to, signal + 1);
      store_twice(value.z, to, signal + 2);
      store_twice(value.w, to, signal + 3);
    }
  }
  HWY_INLINE void store_twice(V value, float* texels, int plane) const {
    const int lanes = static_cast<int>(hn::Lanes(d_));
    float* const to = texels + plane * ring_.pitch();
    const auto part = [&](int first) HWY_ATTR {
      const hn::RebindToSigned<D> di;
      const auto from = hn::ShiftRight<1>(hn::Iota(di, first));
      return hn::TableLookupLanes(value, hn::IndicesFromVec(d_, from));
    };
    hn::StoreU(part(0), d_, to);
    hn::StoreU(lanes == 1 ? value : part(lanes), d_, to + lanes);
  }

  const D d_{};
  const VisibilityUpsampleJob& job_;
  int width_, height_;
  int next_;  // row that is not there yet
  RowRing ring_;
};

/// Lanes are pixels side by side.
template <class D>
class Upsampling {
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;
  using Rows = SignalRows<D, true>;

  /// All exponents count octaves.
  struct Center {
    Triple<V> normal;  // times the power
    SurfacePlane<V> plane;
    V value[2];
    V inv_sigma[2];  // 1 / what a difference of visibility may be
  };
  struct Sums {
    Quad<V> value;
    V total[2];
  };
  /// Of a texel as seen from the pixels of one side: how far away, and its bilinear weight.
  struct Side {
    V offset;
    V nearness;
  };

 public:
  HWY_INLINE explicit Upsampling(const VisibilityUpsampleJob& job) : job_(job), c_(job.constants) {}

  HWY_INLINE void rows(int first, int last) const {
    const int lanes = static_cast<int>(hn::Lanes(d_));
    Rows rows(job_.guide, job_.signal, job_.width, job_.height,
              Area{0, job_.width, std::max(first - 1, 0), last}, RowReach{1, 1, 1});
    HalfRows<D> halves(job_, (first - 1) >> 1);
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
        add_texel(c, halves, halves.row(row) + x - 1, of_column(x, -1), dy, near, sums);
        add_texel(c, halves, halves.row(row) + x + 1, of_column(x, 1), dy, near, sums);
      }
      denoised = select(seen, result(sums), value);
    }
    store4(d_, denoised, row_of<float>(job_.denoised, y) + 4 * x);
  }

  HWY_INLINE Center center(const Rows& rows, const ViewedRow<D>& view, const Quad<V>& value, int x,
                           int y) const {
    const float* const texels = rows.row(y) + x;
    Center c;
    const V power = set(c_.normal_power * octaves);
    c.normal = Triple<V>{rows.load(texels, Rows::normal_x), rows.load(texels, Rows::normal_y),
                         rows.load(texels, Rows::normal_z)} *
               power;
    c.plane = surface_plane(view, rows.load(texels, Rows::view_z),
                            load2(d_, row_of<const float>(job_.depth_slope, y) + 2 * x));
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

  /// Of the texels left (-1) or right (1) of the pixels from `x` on.
  HWY_INLINE Side of_column(int x, int side) const {
    const hn::RebindToSigned<D> di;
    const auto pixel = hn::Iota(di, x);
    const auto texel = hn::ShiftRight<1>(pixel + hn::Set(di, side));
    const M within = hn::RebindMask(d_, hn::Eq(texel, hn::ShiftRight<1>(pixel)));
    return {hn::ConvertTo(d_, texel + texel - pixel),
            hn::IfThenElse(within, set(0.75f), set(0.25f))};
  }

  HWY_INLINE void add_texel(const Center& c, const HalfRows<D>& halves, const float* texels,
                            const Side& column, float dy, float nearness_down, Sums& sums) const {
    using Half = HalfRows<D>;
    const V z = halves.load(texels, Half::view_z);
    const M valid = hn::Gt(z, hn::Zero(d_));
    V exponent = hn::MulAdd(c.normal.x, halves.load(texels, Half::normal_x),
                            set(weight_one - c_.normal_power * octaves));
    exponent = hn::MulAdd(c.normal.y, halves.load(texels, Half::normal_y), exponent);
    exponent = hn::MulAdd(c.normal.z, halves.load(texels, Half::normal_z), exponent);
    const V apart =
        hn::Max(hn::Sqrt(hn::MulAdd(column.offset, column.offset, set(dy * dy))), set(1.0f));
    exponent = c.plane.lowered(exponent, z, column.offset, set(dy), apart, c_.depth_sigma);
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
