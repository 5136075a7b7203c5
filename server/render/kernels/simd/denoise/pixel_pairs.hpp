// The left and the right pixels of squares of 2x2, a lane for every square. Included once per
// instruction set; the guard is Google Highway's convention.
#if defined(HELIOGRAPH_KERNELS_PIXEL_PAIRS_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_PIXEL_PAIRS_HPP
#undef HELIOGRAPH_KERNELS_PIXEL_PAIRS_HPP
#else
#define HELIOGRAPH_KERNELS_PIXEL_PAIRS_HPP
#endif

#include <algorithm>
#include <array>

#include "render/kernels/simd/pixels.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// One row of an image of `width` pixels, from the square in column `square` on. Where the border
/// cuts the last square, its right pixel is zero.
template <class D>
class PixelPairs {
  using V = hn::Vec<D>;
  static constexpr std::size_t most = 2 * hn::MaxLanes(D());

 public:
  HWY_INLINE PixelPairs(int width, int square, int row)
      : square_(square), row_(row), pixels_(width - 2 * square) {}

  HWY_INLINE std::array<Quad<V>, 2> four(const gpu::HostView& image) const {
    std::array<float, 4 * most> space;
    const float* const from = texels<4>(image, space);
    const Quad<V> low = load4(d_, from), high = load4(d_, from + 4 * lanes());
    const auto x = split(low.x, high.x), y = split(low.y, high.y);
    const auto z = split(low.z, high.z), w = split(low.w, high.w);
    return {Quad<V>{x[0], y[0], z[0], w[0]}, Quad<V>{x[1], y[1], z[1], w[1]}};
  }
  HWY_INLINE std::array<Pair<V>, 2> two(const gpu::HostView& image) const {
    std::array<float, 2 * most> space;
    const float* const from = texels<2>(image, space);
    const Pair<V> low = load2(d_, from), high = load2(d_, from + 2 * lanes());
    const auto x = split(low.x, high.x), y = split(low.y, high.y);
    return {Pair<V>{x[0], y[0]}, Pair<V>{x[1], y[1]}};
  }
  /// Words of 32 bits.
  HWY_INLINE std::array<V, 2> one(const gpu::HostView& image) const {
    std::array<float, most> space;
    const float* const from = texels<1>(image, space);
    return split(hn::LoadU(d_, from), hn::LoadU(d_, from + lanes()));
  }

 private:
  static int lanes() { return static_cast<int>(hn::Lanes(D())); }

  template <int channels, std::size_t size>
  HWY_INLINE const float* texels(const gpu::HostView& image, std::array<float, size>& space) const {
    const float* const from = row_of<const float>(image, row_) + 2 * channels * square_;
    if (pixels_ >= 2 * lanes()) return from;
    std::fill(std::copy_n(from, channels * pixels_, space.begin()), space.end(), 0.0f);
    return space.data();
  }

  HWY_INLINE std::array<V, 2> split(V low, V high) const {
#if HWY_TARGET != HWY_SCALAR
    if constexpr (hn::MaxLanes(D()) > 1) {
      return {hn::ConcatEven(d_, high, low), hn::ConcatOdd(d_, high, low)};
    }
#endif
    return {low, high};
  }

  const D d_{};
  int square_, row_;
  int pixels_;
};

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
