// Surfaces of glTF's own materials for host kernels: shaders/lib/lighting/brdf.glsl in vectors.
// Included once per instruction set; the guard is Google Highway's convention.
#if defined(HELIOGRAPH_KERNELS_MATERIAL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_MATERIAL_HPP
#undef HELIOGRAPH_KERNELS_MATERIAL_HPP
#else
#define HELIOGRAPH_KERNELS_MATERIAL_HPP
#endif

#include <numbers>

#include "render/kernels/common/frame_job.hpp"
#include "render/kernels/simd/pixels.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

inline constexpr float dielectric_f0 = 0.04f;

template <class V>
struct SurfaceMaterial {
  Triple<V> normal;
  Triple<V> geometric;
  Triple<V> eye;
  V n_dot_v;
  V roughness;
  Triple<V> f0;
  Triple<V> f90_minus_f0;
  Triple<V> specular_albedo;
  Triple<V> diffuse_albedo;
};

/// A square table, read with linear filtering, clamped at its edges.
template <class D>
class SquareTable {
  using V = hn::Vec<D>;
  using DI = hn::RebindToSigned<D>;
  using VI = hn::Vec<DI>;

 public:
  HWY_INLINE explicit SquareTable(const SquareTexels& table)
      : texels_(row_of<const float>(table.texels, 0)),
        pitch_(static_cast<int>(table.texels.row_pitch / sizeof(float))),
        size_(table.size) {}

  /// Of a table of two floats.
  HWY_INLINE Pair<V> at(V u, V v) const {
    const Place p = place(u, v);
    const Quad<V> top = two_texels(p.above, p.left, p.right);
    const Quad<V> bottom = two_texels(p.below, p.left, p.right);
    return {mix(mix(top.x, top.z, p.across), mix(bottom.x, bottom.z, p.across), p.down),
            mix(mix(top.y, top.w, p.across), mix(bottom.y, bottom.w, p.across), p.down)};
  }
  /// Of a table of one float.
  HWY_INLINE V one_at(V u, V v) const {
    const Place p = place(u, v);
    const auto texel = [&](VI row, VI column)
                           HWY_ATTR { return hn::GatherIndex(d_, texels_, row + column); };
    return mix(mix(texel(p.above, p.left), texel(p.above, p.right), p.across),
               mix(texel(p.below, p.left), texel(p.below, p.right), p.across), p.down);
  }
  /// Of a table of four floats.
  HWY_INLINE Quad<V> four_at(V u, V v) const {
    const Place p = place(u, v);
    const auto texel = [&](VI row, VI column) HWY_ATTR {
      const LaneIndices<D> index(row + hn::ShiftLeft<2>(column));
      return four_words(d_, [&](std::size_t lane) { return texels_ + index.of[lane]; });
    };
    const auto between = [](const Quad<V>& a, const Quad<V>& b, V fraction) HWY_ATTR {
      return Quad<V>{mix(a.x, b.x, fraction), mix(a.y, b.y, fraction), mix(a.z, b.z, fraction),
                     mix(a.w, b.w, fraction)};
    };
    return between(between(texel(p.above, p.left), texel(p.above, p.right), p.across),
                   between(texel(p.below, p.left), texel(p.below, p.right), p.across), p.down);
  }
  int size() const { return size_; }

 private:
  /// Four neighbours: rows in floats, columns in texels, and the weights of the second ones.
  struct Place {
    VI above, below, left, right;
    V across, down;
  };
  HWY_INLINE Place place(V u, V v) const {
    const V half = hn::Set(d_, 0.5f), scale = hn::Set(d_, static_cast<float>(size_));
    const V x = hn::MulSub(u, scale, half), y = hn::MulSub(v, scale, half);
    const V x0 = hn::Floor(x), y0 = hn::Floor(y);
    const VI pitch = hn::Set(di_, pitch_);
    return {hn::Mul(inside(y0, 0), pitch),
            hn::Mul(inside(y0, 1), pitch),
            inside(x0, 0),
            inside(x0, 1),
            x - x0,
            y - y0};
  }
  HWY_INLINE VI inside(V position, int step) const {
    const VI index = hn::ConvertTo(di_, position) + hn::Set(di_, step);
    return hn::Min(hn::Max(index, hn::Zero(di_)), hn::Set(di_, size_ - 1));
  }
  HWY_INLINE Quad<V> two_texels(VI row, VI left, VI right) const {
    const LaneIndices<D> first(row + hn::ShiftLeft<1>(left)), second(row + hn::ShiftLeft<1>(right));
    return two_and_two_words(
        d_, [&](std::size_t lane) { return texels_ + first.of[lane]; },
        [&](std::size_t lane) { return texels_ + second.of[lane]; });
  }

  const D d_{};
  const DI di_{};
  const float* texels_;
  int pitch_;
  int size_;
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE SurfaceMaterial<V> make_material(D d, const Triple<V>& base_color, V metallic,
                                            V roughness, const Triple<V>& normal,
                                            const Triple<V>& geometric, const Triple<V>& eye,
                                            const SquareTable<D>& split_sum) {
  const V one = hn::Set(d, 1.0f);
  const V plain_f0 = hn::Set(d, dielectric_f0);
  SurfaceMaterial<V> m;
  m.normal = normal;
  m.geometric = geometric;
  m.eye = eye;
  m.n_dot_v = clamped(dot(normal, eye), 1e-3f, 1.0f);
  m.roughness = roughness;
  const Pair<V> split = split_sum.at(m.n_dot_v, roughness);
  const V whole = split.x + split.y;
  const V energy_compensation = one / hn::Max(whole, hn::Set(d, 1e-3f)) - one;
  const V dielectric_scale = hn::MulAdd(plain_f0, energy_compensation, one);
  const V dielectric = (one - metallic) * dielectric_scale;
  const V albedo = hn::MulAdd(plain_f0, split.x, split.y) * dielectric_scale;
  const V diffuse = (one - metallic) * (one - hn::Min(albedo, one));
  const auto channel = [&](V color, V& f0, V& f90_minus_f0, V& specular) HWY_ATTR {
    const V metal = metallic * hn::MulAdd(color, energy_compensation, one);
    f0 = hn::MulAdd(dielectric, plain_f0, metal * color);
    f90_minus_f0 = hn::MulAdd(dielectric, one - plain_f0, metal * (one - color));
    specular = hn::MulAdd(f0, whole, f90_minus_f0 * split.y);
  };
  channel(base_color.x, m.f0.x, m.f90_minus_f0.x, m.specular_albedo.x);
  channel(base_color.y, m.f0.y, m.f90_minus_f0.y, m.specular_albedo.y);
  channel(base_color.z, m.f0.z, m.f90_minus_f0.z, m.specular_albedo.z);
  m.diffuse_albedo = base_color * diffuse;
  return m;
}

/// (1 - v.h)^5
template <class V>
HWY_INLINE V schlick_weight(V v_dot_h) {
  const hn::DFromV<V> d;
  const V x = clamped(hn::Set(d, 1.0f) - v_dot_h, 0.0f, 1.0f);
  const V x2 = x * x;
  return x2 * x2 * x;
}

/// D V n.l of one lobe.
template <class V>
HWY_INLINE V specular_lobe(V n_dot_h, V n_dot_l, V n_dot_v, V roughness) {
  const hn::DFromV<V> d;
  const V one = hn::Set(d, 1.0f);
  const V alpha = hn::Max(roughness * roughness, hn::Set(d, 2e-3f));
  const V a2 = alpha * alpha;
  const V narrow = hn::MulAdd(one - n_dot_h, one + n_dot_h, n_dot_h * n_dot_h * a2);
  const V rest = one - a2;
  const V by_light = n_dot_l * hn::Sqrt(hn::MulAdd(n_dot_v * n_dot_v, rest, a2));
  const V by_eye = n_dot_v * hn::Sqrt(hn::MulAdd(n_dot_l * n_dot_l, rest, a2));
  const V masked = hn::Max(by_light + by_eye, hn::Set(d, 1e-7f));
  constexpr float pi = std::numbers::pi_v<float>;
  return hn::Set(d, 0.5f) * a2 * n_dot_l / (hn::Set(d, pi) * narrow * narrow * masked);
}

/// BRDF x cosine for light arriving along -l.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Triple<V> shade_light(D d, const SurfaceMaterial<V>& m, const Triple<V>& l) {
  const V n_dot_l = hn::Max(dot(m.normal, l), hn::Zero(d));
  const Triple<V> h = normalized(l + m.eye);
  const V n_dot_h = clamped(dot(m.normal, h), 0.0f, 1.0f);
  const V lobe = specular_lobe(n_dot_h, n_dot_l, m.n_dot_v, m.roughness);
  const V schlick = schlick_weight(dot(m.eye, h));
  const V spread = n_dot_l * hn::Set(d, std::numbers::inv_pi_v<float>);
  const auto channel = [&](V f0, V f90_minus_f0, V diffuse) HWY_ATTR {
    return hn::MulAdd(hn::MulAdd(f90_minus_f0, schlick, f0), lobe, diffuse * spread);
  };
  return {channel(m.f0.x, m.f90_minus_f0.x, m.diffuse_albedo.x),
          channel(m.f0.y, m.f90_minus_f0.y, m.diffuse_albedo.y),
          channel(m.f0.z, m.f90_minus_f0.z, m.diffuse_albedo.z)};
}

/// What spreads widely of light from everywhere.
template <class V>
HWY_INLINE const Triple<V>& wide_albedo(const SurfaceMaterial<V>& m) {
  return m.diffuse_albedo;
}

/// Whether any lane scatters light to its other side: not without layers.
template <class V>
HWY_INLINE constexpr bool scatters_through(const SurfaceMaterial<V>&) {
  return false;
}

/// Albedo of the diffuse lobe toward the eye of light from the other side.
template <class V>
HWY_INLINE Triple<V> transmitted_albedo(const SurfaceMaterial<V>&) {
  const V zero = hn::Zero(hn::DFromV<V>());
  return {zero, zero, zero};
}

/// Of the narrower specular lobe.
template <class V>
HWY_INLINE V narrower_roughness(const SurfaceMaterial<V>& m) {
  return m.roughness;
}

/// Light of the environment that comes back from the specular lobes, without occlusion.
/// `reflection(normal, roughness)`: the prefiltered radiance that the eye sees about the normal.
template <class V, class Reflection>
HWY_INLINE Triple<V> environment_specular(const SurfaceMaterial<V>& m,
                                          const Reflection& reflection) {
  return m.specular_albedo * reflection(m.normal, m.roughness);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
