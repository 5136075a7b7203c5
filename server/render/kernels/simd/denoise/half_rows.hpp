// Texels of half size as the pixels about them see them. Included once per instruction set; the
// guard is Google Highway's convention.
#if defined(HELIOGRAPH_KERNELS_HALF_ROWS_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_HALF_ROWS_HPP
#undef HELIOGRAPH_KERNELS_HALF_ROWS_HPP
#else
#define HELIOGRAPH_KERNELS_HALF_ROWS_HPP
#endif

#include "render/kernels/common/row_ring.hpp"
#include "render/kernels/simd/denoise/surface_plane.hpp"
#include "render/kernels/simd/guide.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// Rows of texels of half size in planes, every texel twice: the two about a pixel lie one column
/// before it and one behind it.
template <class D>
class HalfRows {
  using V = hn::Vec<D>;

 public:
  enum Plane { normal_x, normal_y, normal_z, view_z, signal, planes = signal + 4 };

  /// `size`: of both images; `first`: the first row that is needed.
  HalfRows(const gpu::HostView& guide, const gpu::HostView& from, glm::ivec2 size, int first)
      : guide_(guide),
        signal_(from),
        size_(size),
        next_(std::max(first, 0)),
        ring_(planes, 2 * size.x, 1, 2) {}

  HWY_INLINE void advance(int last) {
    for (; next_ <= std::min(last, size_.y - 1); ++next_) fill(next_);
  }
  bool has(int y) const { return y >= 0 && y < size_.y; }
  HWY_INLINE const float* row(int y) const { return ring_.row(y); }
  HWY_INLINE V load(const float* texels, int plane) const {
    return hn::LoadU(d_, texels + plane * ring_.pitch());
  }

 private:
  HWY_INLINE void fill(int y) const {
    const int lanes = static_cast<int>(hn::Lanes(d_));
    const float* const guide = row_of<const float>(guide_, y);
    const float* const from = row_of<const float>(signal_, y);
    for (int start = 0; start < size_.x; start += lanes) {
      const int x = std::min(start, size_.x - lanes);
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
  const gpu::HostView& guide_;
  const gpu::HostView& signal_;
  glm::ivec2 size_;
  int next_;  // row that is not there yet
  RowRing ring_;
};

/// Texels of one side as seen from pixels side by side: how far away, pixels, and their bilinear
/// weight.
template <class V>
struct HalfColumn {
  V offset;
  V nearness;
};

/// Left (-1) or right (1) of the pixels from `x` on.
template <class D, class V = hn::Vec<D>>
HWY_INLINE HalfColumn<V> half_column(D d, int x, int side) {
  const hn::RebindToSigned<D> di;
  const auto pixel = hn::Iota(di, x);
  const auto texel = hn::ShiftRight<1>(pixel + hn::Set(di, side));
  const auto within = hn::RebindMask(d, hn::Eq(texel, hn::ShiftRight<1>(pixel)));
  return {hn::ConvertTo(d, texel + texel - pixel),
          hn::IfThenElse(within, hn::Set(d, 0.75f), hn::Set(d, 0.25f))};
}

/// What surfaces of pixels weigh texels of half size by.
template <class D>
class HalfWeights {
  using V = hn::Vec<D>;

 public:
  HWY_INLINE HalfWeights(const Triple<V>& normal, const SurfacePlane<V>& plane, float normal_power,
                         float depth_sigma)
      : normal_(normal * hn::Set(D(), normal_power * octaves)),
        plane_(plane),
        equal_(weight_one - normal_power * octaves),
        depth_sigma_(depth_sigma) {}

  /// The exponent, in octaves, of texels that lie `dy` pixels below.
  HWY_INLINE V exponent(const HalfRows<D>& halves, const float* texels, V z,
                        const HalfColumn<V>& column, float dy) const {
    using Half = HalfRows<D>;
    V exponent = hn::MulAdd(normal_.x, halves.load(texels, Half::normal_x), set(equal_));
    exponent = hn::MulAdd(normal_.y, halves.load(texels, Half::normal_y), exponent);
    exponent = hn::MulAdd(normal_.z, halves.load(texels, Half::normal_z), exponent);
    const V apart =
        hn::Max(hn::Sqrt(hn::MulAdd(column.offset, column.offset, set(dy * dy))), set(1.0f));
    return plane_.lowered(exponent, z, column.offset, set(dy), apart, depth_sigma_);
  }

 private:
  HWY_INLINE V set(float value) const { return hn::Set(D(), value); }

  Triple<V> normal_;  // times the power
  SurfacePlane<V> plane_;
  float equal_;
  float depth_sigma_;
};

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
