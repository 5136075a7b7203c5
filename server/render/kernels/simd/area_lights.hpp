// Rectangles and disks that shine on one side, for host kernels: shaders/lib/lighting/ltc.glsl and
// area_lights.glsl in vectors. Not inlined: few scenes have any. Included once per instruction set;
// the guard is Google Highway's convention.
#if defined(HELIOGRAPH_KERNELS_AREA_LIGHTS_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_AREA_LIGHTS_HPP
#undef HELIOGRAPH_KERNELS_AREA_LIGHTS_HPP
#else
#define HELIOGRAPH_KERNELS_AREA_LIGHTS_HPP
#endif

#include <cmath>
#include <glm/glm.hpp>

#include "render/kernels/simd/material/layers.hpp"
#include "render/kernels/simd/rays.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// The angle of (x, y) for y >= 0, 0 to pi; 0 for (0, 0).
template <class V>
HWY_INLINE V upper_angle(V x, V y) {
  const hn::DFromV<V> d;
  const V wide = hn::Abs(x);
  const auto steep = hn::Gt(y, wide);
  const V ratio = hn::Min(wide, y) / hn::Max(hn::Max(wide, y), hn::Set(d, 1e-37f));
  V angle = hn::Atan(d, ratio);
  angle = hn::IfThenElse(steep, hn::Set(d, 1.57079633f) - angle, angle);
  return hn::IfThenElse(hn::Lt(x, hn::Zero(d)), hn::Set(d, 3.14159265f) - angle, angle);
}

/// What runs along a convex polygon's edges, corner by corner, above the horizon z = 0.
template <class V>
class Contour {
  using D = hn::DFromV<V>;

 public:
  HWY_INLINE Contour()
      : sum_(hn::Zero(d_)),
        leaves_{hn::Set(d_, 1.0f), sum_, sum_},
        returns_(leaves_),
        cut_(hn::Lt(sum_, sum_)) {}

  HWY_INLINE void add(Triple<V> from, Triple<V> to) {
    const V zero = hn::Zero(d_);
    const auto above = hn::Or(hn::Gt(from.z, zero), hn::Gt(to.z, zero));
    if (hn::AllFalse(d_, above)) return;
    const auto comes = hn::And(above, hn::Lt(from.z, zero));
    const auto goes = hn::And(above, hn::Lt(to.z, zero));
    const auto crosses = hn::Or(comes, goes);
    if (!hn::AllFalse(d_, crosses)) {
      const V by = hn::Set(d_, 1.0f) / hn::IfThenElse(crosses, to.z - from.z, hn::Set(d_, 1.0f));
      const Triple<V> horizon{hn::MulSub(from.x, to.z, to.x * from.z) * by,
                              hn::MulSub(from.y, to.z, to.y * from.z) * by, zero};
      const Triple<V> toward = unit(horizon);
      leaves_ = select(goes, toward, leaves_);
      returns_ = select(comes, toward, returns_);
      cut_ = hn::Or(cut_, crosses);
      to = select(goes, horizon, to);
      from = select(comes, horizon, from);
    }
    sum_ = sum_ + hn::IfThenElseZero(above, edge_integral(unit(from), unit(to)));
  }

  /// Fraction of the clamped cosine about +z that the polygon covers.
  HWY_INLINE V covered_cosine() const {
    V sum = sum_;
    if (!hn::AllFalse(d_, cut_)) {
      sum = sum + hn::IfThenElseZero(cut_, edge_integral(leaves_, returns_));
    }
    return clamped(hn::Abs(sum) * hn::Set(d_, 0.5f * std::numbers::inv_pi_v<float>), 0.0f, 1.0f);
  }

 private:
  static HWY_INLINE Triple<V> unit(const Triple<V>& v) {
    const D d;
    return v * (hn::Set(d, 1.0f) / hn::Sqrt(hn::Max(dot(v, v), hn::Set(d, 1e-37f))));
  }
  /// The angle between unit vectors times the z of the axis that turns `a` into `b`.
  static HWY_INLINE V edge_integral(const Triple<V>& a, const Triple<V>& b) {
    const D d;
    const Triple<V> axis = cross_of(a, b);
    const V sine = hn::Sqrt(dot(axis, axis));
    const auto apart = hn::Gt(sine, hn::Set(d, 1e-7f));
    const V turn = upper_angle(dot(a, b), sine) / hn::IfThenElse(apart, sine, hn::Set(d, 1.0f));
    return axis.z * hn::IfThenElse(apart, turn, hn::Set(d, 1.0f));
  }

  const D d_{};
  V sum_;
  Triple<V> leaves_;   // where the outline goes below the horizon
  Triple<V> returns_;  // and where it comes back
  hn::Mask<D> cut_;
};

/// World -> the frame of a lobe: z is its normal, the eye lies over +x.
template <class V>
struct ShadingFrame {
  Triple<V> x, y, z;
  HWY_INLINE ShadingFrame(const Triple<V>& normal, const Triple<V>& eye) : z(normal) {
    const hn::DFromV<V> d;
    const Triple<V> along = eye - normal * dot(eye, normal);
    const V squared = dot(along, along);
    const auto head_on = hn::Lt(squared, hn::Set(d, 1e-8f));
    x = along * (hn::Set(d, 1.0f) / hn::Sqrt(hn::Max(squared, hn::Set(d, 1e-8f))));
    y = cross_of(normal, x);
    if (hn::AllFalse(d, head_on)) return;
    Triple<V> tangent, bitangent;
    orthonormal_basis(normal, tangent, bitangent);
    x = select(head_on, tangent, x);
    y = select(head_on, bitangent, y);
  }
  HWY_INLINE Triple<V> of(const Triple<V>& v) const { return {dot(x, v), dot(y, v), dot(z, v)}; }
};

inline glm::vec3 area_bitangent(const shared::Light& light) {
  return glm::cross(light.direction, light.tangent);
}

/// Fractions of the diffuse (x) and the specular (y) lobe that the light covers, unshadowed.
template <class D, class V = hn::Vec<D>>
HWY_NOINLINE Pair<V> area_light_shares(D d, const shared::Light& light, const SquareTexels& ltc,
                                       const Triple<V>& normal, const Triple<V>& eye, V n_dot_v,
                                       V roughness, const Triple<V>& position) {
  constexpr float least_ltc_roughness = 0.03f;
  constexpr int disk_corners = 16;
  const V one = hn::Set(d, 1.0f), zero = hn::Zero(d);
  const Triple<V> offset = splat(d, light.position) - position;
  const auto shines = hn::Lt(dot(offset, splat(d, light.direction)), zero);
  if (hn::AllFalse(d, shines)) return {zero, zero};
  const SquareTable<D> table(ltc);
  const auto size = static_cast<float>(table.size());
  const auto entry_at = [&](V of) HWY_ATTR {
    return hn::MulAdd(of, hn::Set(d, (size - 1.0f) / size), hn::Set(d, 0.5f / size));
  };
  const Quad<V> entry =
      table.four_at(entry_at(hn::Sqrt(one - n_dot_v)),
                    entry_at(hn::Max(roughness, hn::Set(d, least_ltc_roughness))));
  const auto moved_by_inverse = [&](const Triple<V>& v) HWY_ATTR {
    return Triple<V>{hn::MulAdd(entry.x, v.x, entry.z * v.z), v.y,
                     hn::MulAdd(entry.y, v.x, entry.w * v.z)};
  };
  const bool disk = light.type == shared::light_disk;
  const int corners = disk ? disk_corners : 4;
  const float angle = 2.0f * std::numbers::pi_v<float> / static_cast<float>(corners);
  // Corners run around a circle; a rectangle's, squeezed, begin at a diagonal. A disk's polygon has
  // the disk's area.
  const float reach = disk ? light.radius * std::sqrt(angle / std::sin(angle)) : std::sqrt(2.0f);
  const ShadingFrame<V> frame(normal, eye);
  const Triple<V> middle = frame.of(offset);
  const Triple<V> along =
      frame.of(splat(d, light.tangent * (disk ? reach : reach * light.half_width)));
  const Triple<V> across =
      frame.of(splat(d, area_bitangent(light) * (disk ? reach : reach * light.half_height)));
  const glm::vec2 turn(std::cos(angle), std::sin(angle));
  glm::vec2 at(std::sqrt(0.5f));
  const auto corner_at = [&](const glm::vec2& c) HWY_ATTR {
    return middle + along * hn::Set(d, c.x) + across * hn::Set(d, c.y);
  };
  Triple<V> before = corner_at(at), moved_before = moved_by_inverse(before);
  Contour<V> diffuse, specular;
  for (int i = 0; i < corners; ++i) {
    at = {at.x * turn.x - at.y * turn.y, at.x * turn.y + at.y * turn.x};
    const Triple<V> corner = corner_at(at), moved = moved_by_inverse(corner);
    diffuse.add(before, corner);
    specular.add(moved_before, moved);
    before = corner;
    moved_before = moved;
  }
  // Fraction of the lobe above the horizon, where it is cut off and made as bright again.
  const V slant = hn::Sqrt(hn::MulAdd(entry.y, entry.y, entry.x * entry.x));
  const V above = hn::MulAdd(hn::Set(d, 0.5f), entry.x / slant, hn::Set(d, 0.5f));
  return {hn::IfThenElseZero(shines, diffuse.covered_cosine()),
          hn::IfThenElseZero(shines, hn::Min(specular.covered_cosine() / above, one))};
}

/// Light that surfaces send to the eye from an area, unshadowed: radiance.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Triple<V> area_contribution(D d, const shared::Light& light, const SquareTexels& ltc,
                                       const SurfaceMaterial<V>& m, const Triple<V>& position) {
  const Pair<V> shares =
      area_light_shares(d, light, ltc, m.normal, m.eye, m.n_dot_v, m.roughness, position);
  return splat(d, light.color) * (m.diffuse_albedo * shares.x + m.specular_albedo * shares.y);
}
template <class D, class V = hn::Vec<D>>
HWY_INLINE Triple<V> area_contribution(D d, const shared::Light& light, const SquareTexels& ltc,
                                       const LayeredMaterial<V>& m, const Triple<V>& position) {
  Pair<V> shares =
      area_light_shares(d, light, ltc, m.normal, m.eye, m.n_dot_v, m.roughness, position);
  if (m.grained) {
    const Triple<V> bent = reflection_normal(m);
    const V cosine = clamped(dot(bent, m.eye), 1e-3f, 1.0f);
    shares.y = area_light_shares(d, light, ltc, bent, m.eye, cosine, m.roughness, position).y;
  }
  Triple<V> energy = wide_albedo(m) * shares.x + under_coat_albedo(m) * shares.y;
  if (m.coated) {
    const V of_coat = area_light_shares(d, light, ltc, m.coat_normal, m.eye, m.coat_n_dot_v,
                                        m.coat_roughness, position)
                          .y *
                      m.coat_albedo;
    energy = {energy.x + of_coat, energy.y + of_coat, energy.z + of_coat};
  }
  if (m.translucent) {
    const V behind =
        area_light_shares(d, light, ltc, -m.normal, m.eye, m.n_dot_v, m.roughness, position).x;
    energy = energy + m.diffuse_transmitted * behind;
  }
  return splat(d, light.color) * energy;
}

/// A point of an area as seen from surfaces.
template <class V>
struct AreaSample {
  Triple<V> direction;  // unit length
  V distance;           // metres
  V solid_angle;        // 1 / density over solid angle; 0 behind the light
};

template <class V>
HWY_INLINE AreaSample<V> sample_of_point(const shared::Light& light, const Triple<V>& offset,
                                         float area) {
  const hn::DFromV<V> d;
  const V squared = hn::Max(dot(offset, offset), hn::Set(d, 1e-12f));
  AreaSample<V> s;
  s.distance = hn::Sqrt(squared);
  s.direction = offset * (hn::Set(d, 1.0f) / s.distance);
  const V facing = hn::Max(hn::Neg(dot(splat(d, light.direction), s.direction)), hn::Zero(d));
  s.solid_angle = hn::Set(d, area) * facing / squared;
  return s;
}

/// A point of a rectangle, uniform over the solid angle it is seen under (Urena, Fajardo and King
/// 2013).
template <class V>
HWY_INLINE AreaSample<V> sample_spherical_rectangle(const shared::Light& light,
                                                    const Triple<V>& middle, const Pair<V>& u) {
  const hn::DFromV<V> d;
  const V one = hn::Set(d, 1.0f), zero = hn::Zero(d);
  const glm::vec3 bitangent = area_bitangent(light);
  const V height = dot(middle, splat(d, light.direction));
  const V center_x = dot(middle, splat(d, light.tangent)),
          center_y = dot(middle, splat(d, bitangent));
  const V half_x = hn::Set(d, light.half_width), half_y = hn::Set(d, light.half_height);
  const V low_x = center_x - half_x, high_x = center_x + half_x;
  const V low_y = center_y - half_y, high_y = center_y + half_y;
  // The second component of a plane's normal (height, side), unit length.
  const auto plane = [&](V side) HWY_ATTR {
    return side / hn::Sqrt(hn::MulAdd(height, height, side * side));
  };
  const V bottom = plane(hn::Neg(low_y)), top = plane(high_y);
  const V right = plane(high_x), left = plane(hn::Neg(low_x));
  const auto corner = [&](V a, V b)
                          HWY_ATTR { return hn::Acos(d, clamped(hn::Neg(a * b), -1.0f, 1.0f)); };
  const V rest =
      hn::Set(d, 2.0f * std::numbers::pi_v<float>) - corner(top, left) - corner(left, bottom);
  AreaSample<V> s;
  s.solid_angle = hn::Max(corner(bottom, right) + corner(right, top) - rest, zero);
  const V around = hn::MulAdd(u.x, s.solid_angle, rest);
  const V f = hn::MulSub(hn::Cos(d, around), bottom, top) / hn::Sin(d, around);
  const V size = one / hn::Max(hn::Sqrt(hn::MulAdd(f, f, bottom * bottom)), one);
  const V cosine = hn::IfThenElse(hn::Gt(f, zero), size, hn::Neg(size));
  V x = hn::Neg(cosine * height) /
        hn::Sqrt(hn::Max(hn::NegMulAdd(cosine, cosine, one), hn::Set(d, 1e-12f)));
  x = hn::Min(hn::Max(x, low_x), high_x);
  const V squared = hn::MulAdd(x, x, height * height), flat = hn::Sqrt(squared);
  const auto along = [&](V y) HWY_ATTR { return y / hn::Sqrt(hn::MulAdd(y, y, squared)); };
  const V h = mix(along(low_y), along(high_y), u.y);
  const V remaining = hn::NegMulAdd(h, h, one);
  const auto inside = hn::Gt(remaining, hn::Set(d, 1e-6f));
  const V y =
      hn::IfThenElse(inside, h * flat / hn::Sqrt(hn::Max(remaining, hn::Set(d, 1e-6f))), high_y);
  const Triple<V> offset =
      splat(d, light.tangent) * x + splat(d, bitangent) * y + splat(d, light.direction) * height;
  s.distance = length(offset);
  s.direction = offset * (one / s.distance);
  return s;
}

template <class V>
HWY_NOINLINE AreaSample<V> sample_area(const shared::Light& light, const Triple<V>& position,
                                       const Pair<V>& u) {
  const hn::DFromV<V> d;
  const Triple<V> middle = splat(d, light.position) - position;
  const auto point = [&](V x, V y, float area) HWY_ATTR {
    const Triple<V> offset =
        middle + splat(d, light.tangent) * x + splat(d, area_bitangent(light)) * y;
    return sample_of_point(light, offset, area);
  };
  if (light.type == shared::light_disk) {
    const Pair<V> at = sample_disk(u.x, u.y);
    const V radius = hn::Set(d, light.radius);
    return point(at.x * radius, at.y * radius,
                 std::numbers::pi_v<float> * light.radius * light.radius);
  }
  const float area = 4.0f * light.half_width * light.half_height;
  // Small or distant ones, whose angles cancel in single precision, by their area.
  const auto small = hn::Lt(hn::Set(d, area), hn::Set(d, 0.02f) * dot(middle, middle));
  const V two = hn::Set(d, 2.0f), one = hn::Set(d, 1.0f);
  AreaSample<V> s = point(hn::MulSub(two, u.x, one) * hn::Set(d, light.half_width),
                          hn::MulSub(two, u.y, one) * hn::Set(d, light.half_height), area);
  if (!hn::AllTrue(d, small)) {
    const AreaSample<V> whole = sample_spherical_rectangle(light, middle, u);
    s.direction = select(small, s.direction, whole.direction);
    s.distance = hn::IfThenElse(small, s.distance, whole.distance);
    s.solid_angle = hn::IfThenElse(small, s.solid_angle, whole.solid_angle);
  }
  const auto shines = hn::Lt(dot(middle, splat(d, light.direction)), hn::Zero(d));
  s.solid_angle = hn::IfThenElseZero(shines, s.solid_angle);
  return s;
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
