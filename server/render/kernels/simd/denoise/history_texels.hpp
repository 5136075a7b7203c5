// Histories of 16 bits a channel in host kernels: shaders/lib/denoise/history_texels.glsl in
// vectors. Included once per instruction set; the guard is Google Highway's convention.
#if defined(HELIOGRAPH_KERNELS_HISTORY_TEXELS_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_HISTORY_TEXELS_HPP
#undef HELIOGRAPH_KERNELS_HISTORY_TEXELS_HPP
#else
#define HELIOGRAPH_KERNELS_HISTORY_TEXELS_HPP
#endif

#include "render/kernels/simd/pixels.hpp"
#include "shaders/shared/denoise.h"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// Texels that add up as they are.
struct LinearTexels {
  /// What can be added up, of whole texels with their channels side by side.
  template <class D, class V = hn::Vec<D>>
  static HWY_INLINE V linear(D, V texels) {
    return texels;
  }
  template <class V>
  static HWY_INLINE Quad<V> linear(const Quad<V>& texels) {
    return texels;
  }
};

/// Half floats, as in rgba16f images.
struct Halves : LinearTexels {
  template <class D, class D16 = hn::Rebind<std::uint16_t, D>>
  static HWY_INLINE hn::Vec<D> widened(D d, hn::Vec<D16> texels) {
    return hn::PromoteTo(d, hn::BitCast(hn::Rebind<hwy::float16_t, D>(), texels));
  }
  /// What scales linear combinations of widened channels.
  static constexpr float unit = 1.0f;
};

/// Halves of which the last two are mean and deviation: those add up to no deviation, but mean and
/// mean square do.
struct MeanAndDeviation : Halves {
  template <class D, class V = hn::Vec<D>>
  static HWY_INLINE V linear(D d, V texels) {
#if HWY_TARGET != HWY_SCALAR
    if constexpr (hn::MaxLanes(D()) >= 4) {
      const hn::RebindToSigned<D> di;
      const V squares = texels * texels;
      const auto last = hn::Eq(hn::And(hn::Iota(di, 0), hn::Set(di, 3)), hn::Set(di, 3));
      return hn::IfThenElse(hn::RebindMask(d, last), squares + hn::Shuffle2301(squares), texels);
    }
#endif
    (void)d;
    return texels;  // of one channel: whole texels are made linear below
  }
  template <class V>
  static HWY_INLINE Quad<V> linear(const Quad<V>& t) {
    return {t.x, t.y, t.z, hn::MulAdd(t.z, t.z, t.w * t.w)};
  }
};

/// 0 to 1 in steps of 1 / 65535, as in rgba16 images.
struct Fractions : LinearTexels {
  template <class D, class D16 = hn::Rebind<std::uint16_t, D>>
  static HWY_INLINE hn::Vec<D> widened(D d, hn::Vec<D16> texels) {
    return hn::ConvertTo(d, hn::PromoteTo(hn::RebindToSigned<D>(), texels));
  }
  static constexpr float unit = 1.0f / 65535.0f;
};

/// In which direction the channels of pixels side by side are rounded.
template <class D>
class Rounding {
  using DU = hn::RebindToUnsigned<D>;
  using VU = hn::Vec<DU>;

 public:
  HWY_INLINE Rounding(int x, int y, std::uint32_t frame) {
    const DU du;
    const VU column = hn::Iota(du, static_cast<std::uint32_t>(x));
    const VU row = hn::Set(du, static_cast<std::uint32_t>(y) * 0xd8163841u);
    VU hash = hn::Mul(column, hn::Set(du, 0x8da6b343u)) + row;
    hash = hn::Mul(hn::Xor(hash, hn::ShiftRight<16>(hash)), hn::Set(du, 0x7feb352du));
    turn_ = hash + hn::Set(du, frame * shared::rounding_step);
  }

  /// Of `channel`, uniform in 32 bits.
  HWY_INLINE VU bits(std::uint32_t channel) const { return turn_ + hn::Set(DU(), channel << 30u); }

 private:
  VU turn_;
};

/// The half float below or above, each the more probable the nearer it is.
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Vec<hn::Rebind<std::uint16_t, D>> narrowed(Halves, D d, V value,
                                                          const Rounding<D>& rounding,
                                                          std::uint32_t channel) {
  const hn::RebindToUnsigned<D> du;
  const V finite = clamped(value, -shared::largest_half, shared::largest_half);
  const auto sum = hn::BitCast(du, finite) + hn::ShiftRight<19>(rounding.bits(channel));
  const auto exact = hn::BitCast(d, hn::And(sum, hn::Set(du, 0xffffe000u)));
  const hn::Rebind<hwy::float16_t, D> halves;
  return hn::BitCast(hn::Rebind<std::uint16_t, D>(), hn::DemoteTo(halves, exact));
}
/// The same of fractions; those next to nothing away from a step are on it.
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Vec<hn::Rebind<std::uint16_t, D>> narrowed(Fractions, D d, V value,
                                                          const Rounding<D>& rounding,
                                                          std::uint32_t channel) {
  const hn::RebindToSigned<D> di;
  const auto turn = hn::BitCast(di, hn::ShiftRight<16>(rounding.bits(channel)));
  const V offset = hn::MulAdd(hn::ConvertTo(d, turn), hn::Set(d, shared::rounding_range / 65536.0f),
                              hn::Set(d, 0.5f - 0.5f * shared::rounding_range));
  const V steps = hn::MulAdd(clamped(value, 0.0f, 1.0f), hn::Set(d, 65535.0f), offset);
  return hn::DemoteTo(hn::Rebind<std::uint16_t, D>(), hn::ConvertTo(di, steps));
}

/// Texels side by side, the first in column `x` of row `y`, as their format makes them linear.
template <class Format, class D, class V = hn::Vec<D>>
HWY_INLINE Quad<V> load_history4(D d, const gpu::HostView& image, int x, int y) {
  const hn::Rebind<std::uint16_t, D> d16;
  hn::Vec<decltype(d16)> a, b, c, e;
  hn::LoadInterleaved4(d16, row_of<const std::uint16_t>(image, y) + 4 * x, a, b, c, e);
  const auto channel = [d](auto texels) HWY_ATTR {
    const V value = Format::widened(d, texels);
    return Format::unit == 1.0f ? value : value * hn::Set(d, Format::unit);
  };
  return Format::linear(Quad<V>{channel(a), channel(b), channel(c), channel(e)});
}
template <class Format, class D, class V = hn::Vec<D>>
HWY_INLINE void store_history4(D d, const Quad<V>& t, const Rounding<D>& rounding,
                               const gpu::HostView& image, int x, int y) {
  hn::StoreInterleaved4(
      narrowed(Format(), d, t.x, rounding, 0), narrowed(Format(), d, t.y, rounding, 1),
      narrowed(Format(), d, t.z, rounding, 2), narrowed(Format(), d, t.w, rounding, 3),
      hn::Rebind<std::uint16_t, D>(), row_of<std::uint16_t>(image, y) + 4 * x);
}

/// The same of two half floats.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Pair<V> load_halves2(D d, const gpu::HostView& image, int x, int y) {
  const hn::Rebind<std::uint16_t, D> d16;
  hn::Vec<decltype(d16)> a, b;
  hn::LoadInterleaved2(d16, row_of<const std::uint16_t>(image, y) + 2 * x, a, b);
  return {Halves::widened(d, a), Halves::widened(d, b)};
}
template <class D, class V = hn::Vec<D>>
HWY_INLINE void store_halves2(D d, const Pair<V>& t, const Rounding<D>& rounding,
                              const gpu::HostView& image, int x, int y) {
  hn::StoreInterleaved2(narrowed(Halves(), d, t.x, rounding, 0),
                        narrowed(Halves(), d, t.y, rounding, 1), hn::Rebind<std::uint16_t, D>(),
                        row_of<std::uint16_t>(image, y) + 2 * x);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
