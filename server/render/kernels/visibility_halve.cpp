#include "render/kernels/simd/rows.hpp"
#include "render/kernels/visibility_half.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/visibility_halve.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/simd/denoise/pixel_pairs.hpp"
#include "render/kernels/simd/denoise/surface_plane.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// Lanes are texels of half size side by side.
template <class D>
class Halving {
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;

  /// One pixel of every square.
  struct Pixels {
    Quad<V> guide;
    Pair<V> slope;
    Quad<V> signal;
    M seen;
  };
  /// The pixels whose surfaces the texels show.
  struct First {
    Quad<V> guide;
    Pair<V> slope;
    V x, y;  // in the square
    M known;
  };
  struct Sums {
    Quad<V> value;
    V total;
  };

 public:
  HWY_INLINE explicit Halving(const VisibilityHalveJob& job)
      : job_(job), halved_width_((job.width + 1) / 2) {}

  HWY_INLINE void rows(int first, int last) const {
    const int lanes = static_cast<int>(hn::Lanes(d_));
    for (int y = first; y < last; ++y) {
      const ViewedRow<D> view(job_.frame, 2 * y);
      for (int x = 0; x < halved_width_; x += lanes) {
        block(view, std::min(x, halved_width_ - lanes), y);
      }
    }
  }

 private:
  HWY_INLINE V set(float value) const { return hn::Set(d_, value); }

  HWY_INLINE void block(const ViewedRow<D>& view, int x, int y) const {
    const V zero = hn::Zero(d_);
    First first{{zero, zero, zero, zero}, {zero, zero}, zero, zero, hn::Gt(zero, zero)};
    Sums sums{{zero, zero, zero, zero}, zero};
    for (int row = 0; row < 2 && 2 * y + row < job_.height; ++row) {
      std::array<Pixels, 2> pair;
      load_pairs(x, 2 * y + row, pair);
      for (int column = 0; column < 2; ++column) {
        add(view, pair[static_cast<std::size_t>(column)], static_cast<float>(column),
            static_cast<float>(row), first, sums);
      }
    }
    const V inverse =
        hn::IfThenElseZero(hn::Gt(sums.total, zero), reciprocal(hn::Max(sums.total, set(1e-6f))));
    const V square = inverse * inverse;
    store4(d_, first.guide, row_of<float>(job_.half_guide, y) + 4 * x);
    hn::StoreInterleaved2(first.slope.x + first.slope.x, first.slope.y + first.slope.y, d_,
                          row_of<float>(job_.half_slope, y) + 2 * x);
    store4(d_,
           {sums.value.x * inverse, sums.value.y * inverse, sums.value.z * square,
            sums.value.w * square},
           row_of<float>(job_.half_signal, y) + 4 * x);
  }

  HWY_INLINE void add(const ViewedRow<D>& view, const Pixels& q, float column, float row,
                      First& first, Sums& sums) const {
    const M begins = hn::AndNot(first.known, q.seen);
    first.guide = select(begins, q.guide, first.guide);
    first.slope = {hn::IfThenElse(begins, q.slope.x, first.slope.x),
                   hn::IfThenElse(begins, q.slope.y, first.slope.y)};
    first.x = hn::IfThenElse(begins, set(column), first.x);
    first.y = hn::IfThenElse(begins, set(row), first.y);
    first.known = hn::Or(first.known, q.seen);
    const V exponent =
        edge_exponent(view, first, q.guide, set(column) - first.x, set(row) - first.y);
    const V weight = edge_weight(q.seen, hn::IfThenElse(begins, set(weight_one), exponent));
    sums.value.x = hn::MulAdd(weight, q.signal.x, sums.value.x);
    sums.value.y = hn::MulAdd(weight, q.signal.y, sums.value.y);
    const V square = weight * weight;
    sums.value.z = hn::MulAdd(square, q.signal.z, sums.value.z);
    sums.value.w = hn::MulAdd(square, q.signal.w, sums.value.w);
    sums.total = sums.total + weight;
  }

  /// Of two surfaces, the second `dx` and `dy` pixels from the first:
  /// shaders/lib/denoise/edge_stopping.glsl.
  HWY_INLINE V edge_exponent(const ViewedRow<D>& view, const First& p, const Quad<V>& q, V dx,
                             V dy) const {
    const Triple<V> a{p.guide.x, p.guide.y, p.guide.z}, b{q.x, q.y, q.z};
    const V sizes = hn::Max(dot(a, a) * dot(b, b), set(1e-24f));
    const V cosine = dot(a, b) * reciprocal_sqrt(sizes);
    const float power = job_.constants.normal_power * octaves;
    const V of_normal = hn::MulAdd(set(power), cosine, set(weight_one - power));
    const V apart = hn::Sqrt(hn::MulAdd(dx, dx, dy * dy));
    return surface_plane(view, p.guide.w, p.slope)
        .lowered(of_normal, q.w, dx, dy, apart, job_.constants.depth_sigma);
  }

  /// The left and the right pixels of the squares from `x` on, in row `y` of the frame.
  HWY_INLINE void load_pairs(int x, int y, std::array<Pixels, 2>& pair) const {
    const PixelPairs<D> from(job_.width, x, y);
    const auto guide = from.four(job_.guide), signal = from.four(job_.signal);
    const auto slope = from.two(job_.depth_slope);
    for (std::size_t i = 0; i < 2; ++i) {
      pair[i] = {guide[i], slope[i], signal[i], hn::Gt(guide[i].w, hn::Zero(d_))};
    }
  }

  const D d_{};
  const VisibilityHalveJob& job_;
  int halved_width_;
};

void halve_rows(const VisibilityHalveJob& job, int first, int last) {
  run_rows<Halving>(job, (job.width + 1) / 2, first, last);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(halve_rows);

void visibility_halve(const VisibilityHalveJob& job) {
  for_each_band((job.height + 1) / 2, [&](int first, int last) {
    HWY_DYNAMIC_DISPATCH(halve_rows)(job, first, last);
  });
}

}  // namespace heliograph::render::kernels
#endif
