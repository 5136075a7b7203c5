// Looking up the environment as shaders/lib/lighting/environment.glsl does, a lane for every
// direction. Included once per instruction set; the guard is Google Highway's convention.
#if defined(HELIOGRAPH_KERNELS_ENVIRONMENT_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_ENVIRONMENT_HPP
#undef HELIOGRAPH_KERNELS_ENVIRONMENT_HPP
#else
#define HELIOGRAPH_KERNELS_ENVIRONMENT_HPP
#endif

#include <numbers>

#include "render/kernels/simd/lanes.hpp"
#include "render/resources/host_tables.hpp"
#include "shaders/shared/frame_constants.h"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// World direction -> direction in the environment's own frame.
HWY_INLINE Float3 environment_direction(const shared::FrameConstants& frame, const Float3& world) {
  const Float c = number(frame.environment_cos), s = number(frame.environment_sin);
  return {hn::MulSub(c, world.x, s * world.z), world.y, hn::MulAdd(s, world.x, c * world.z)};
}

/// `intensity` times the `map` toward `world`, filtered; repeats around the equator.
HWY_INLINE Float3 radiance_from(const RadianceMap& map, const shared::FrameConstants& frame,
                                const Float3& world, float intensity) {
  const Float3 d = environment_direction(frame, world);
  const int width = map.width, height = map.height;
  const Float u = angle_of(d.x, d.z) * number(0.5f * std::numbers::inv_pi_v<float>);
  const Float from_top = hn::Acos(tag, clamped(d.y, -1.0f, 1.0f));
  const Float x = hn::MulSub(u + number(0.5f), number(static_cast<float>(width)), number(0.5f));
  const Float y = hn::MulSub(from_top * number(std::numbers::inv_pi_v<float>),
                             number(static_cast<float>(height)), number(0.5f));
  const Float corner_x = hn::Floor(x), corner_y = hn::Floor(y);
  const auto around = [width](Integer column) {
    const Mask before = float_mask(hn::Lt(column, integer(0)));
    const Mask behind = float_mask(hn::Gt(column, integer(width - 1)));
    return select(before, integer(width - 1), select(behind, integer(0), column));
  };
  const auto inside = [height](Integer row) {
    return hn::Min(hn::Max(row, integer(0)), integer(height - 1));
  };
  const Integer column = truncated(corner_x), row = truncated(corner_y);
  const Integer left = around(column), right = around(hn::Add(column, integer(1)));
  const Integer top = hn::Mul(inside(row), integer(width));
  const Integer bottom = hn::Mul(inside(hn::Add(row, integer(1))), integer(width));
  const auto texel = [&map](Integer line, Integer index) {
    return gather3(tag, map.texels, hn::Mul(hn::Add(line, index), integer(3)));
  };
  const Float across = x - corner_x, down = y - corner_y;
  return mix(mix(texel(top, left), texel(top, right), across),
             mix(texel(bottom, left), texel(bottom, right), across), down) *
         number(intensity);
}

class EnvironmentLanes {
 public:
  EnvironmentLanes(const shared::FrameConstants& frame, const Environment& environment)
      : frame_(frame), environment_(environment) {}

  /// What lights the scene.
  HWY_INLINE Float3 radiance(const Float3& world) const {
    return radiance_from(environment_.radiance(), frame_, world, frame_.environment_intensity);
  }

  /// GGX-prefiltered radiance about the reflected direction `world`.
  HWY_INLINE Float3 reflection(const Float3& world, Float roughness) const {
    const Face face = face_of(own_direction(world));
    const int last = static_cast<int>(environment_.levels.size()) - 1;
    const Float level = roughness * number(static_cast<float>(last));
    const Integer finer = hn::Min(truncated(level), integer(last));
    const Integer coarser = hn::Min(hn::Add(finer, integer(1)), integer(last));
    const Float fraction = level - to_float(finer);
    return mix(cube_texel(face, finer), cube_texel(face, coarser), fraction) *
           number(frame_.environment_intensity);
  }

  /// Irradiance / pi of surfaces facing `world`.
  HWY_INLINE Float3 irradiance(const Float3& world) const {
    const Float3 n = own_direction(world);
    const auto term = [this](int i) { return numbers(glm::vec3(frame_.irradiance[i])); };
    Float3 sum = term(0);
    sum = multiply_add(term(1), n.y, sum);
    sum = multiply_add(term(2), n.z, sum);
    sum = multiply_add(term(3), n.x, sum);
    sum = multiply_add(term(4), n.x * n.y, sum);
    sum = multiply_add(term(5), n.y * n.z, sum);
    sum = multiply_add(term(6), hn::MulSub(number(3.0f) * n.z, n.z, one()), sum);
    sum = multiply_add(term(7), n.x * n.z, sum);
    sum = multiply_add(term(8), hn::MulSub(n.x, n.x, n.y * n.y), sum);
    return Float3{at_least(sum.x, 0.0f), at_least(sum.y, 0.0f), at_least(sum.z, 0.0f)} *
           number(frame_.environment_intensity);
  }

 private:
  HWY_INLINE Float3 own_direction(const Float3& world) const {
    return environment_direction(frame_, world);
  }

  struct Face {
    Integer number;
    Float x, y;  // 0 to 1
  };

  /// Vulkan's order of faces and their axes.
  static HWY_INLINE Face face_of(const Float3& d) {
    const Float x = hn::Abs(d.x), y = hn::Abs(d.y), z = hn::Abs(d.z);
    const Mask along_z = hn::And(hn::Ge(z, x), hn::Ge(z, y));
    const Mask along_y = hn::AndNot(along_z, hn::Ge(y, x));
    const Float major = select(along_z, d.z, select(along_y, d.y, d.x));
    const Mask back = hn::Lt(major, zero());
    const auto turned = [&](Float v) { return select(back, hn::Neg(v), v); };
    const Float s = select(along_z, turned(d.x), select(along_y, d.x, hn::Neg(turned(d.z))));
    const Float t = select(along_y, turned(d.z), hn::Neg(d.y));
    const Integer axis = select(along_z, integer(4), select(along_y, integer(2), integer(0)));
    const Float half = number(0.5f) / at_least(hn::Abs(major), 1e-30f);
    return {hn::Add(axis, select(back, integer(1), integer(0))), hn::MulAdd(s, half, number(0.5f)),
            hn::MulAdd(t, half, number(0.5f))};
  }

  HWY_INLINE Float3 cube_texel(const Face& face, Integer level) const {
    const Records record(environment_.levels.data(), level, sizeof(Environment::Level) / 4);
    const Integer size = record.whole(HELIOGRAPH_WORD(Environment::Level, size));
    const Integer first = record.whole(HELIOGRAPH_WORD(Environment::Level, first));
    const Integer pitch = hn::Add(size, integer(2));
    // The rim is one texel wide: its first stands half a texel before the face.
    const Float x = hn::MulAdd(face.x, to_float(size), number(0.5f));
    const Float y = hn::MulAdd(face.y, to_float(size), number(0.5f));
    const Integer column = truncated(x), row = truncated(y);
    const Integer line = hn::Add(hn::Mul(face.number, pitch), row);
    const Integer corner = hn::Add(first, hn::ShiftLeft<2>(hn::Add(hn::Mul(line, pitch), column)));
    const Integer down = hn::ShiftLeft<2>(pitch);
    const auto texel = [this](Integer index) {
      const LaneIndices<Tag> at(index);
      const float* const cube = environment_.cube.data();
      const Float4 t = four_words(tag, [&](std::size_t lane) { return cube + at.of[lane]; });
      return Float3{t.x, t.y, t.z};
    };
    const Float across = x - to_float(column);
    const Float3 top = mix(texel(corner), texel(hn::Add(corner, integer(4))), across);
    const Integer below = hn::Add(corner, down);
    const Float3 bottom = mix(texel(below), texel(hn::Add(below, integer(4))), across);
    return mix(top, bottom, y - to_float(row));
  }

  const shared::FrameConstants& frame_;
  const Environment& environment_;
};

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
