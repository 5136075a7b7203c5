// Directions in proportion to the environment's luminance, as
// shaders/lib/lighting/environment_sampling.glsl draws them, a lane for every direction. Included
// once per instruction set; the guard is Google Highway's convention.
#if defined(HELIOGRAPH_KERNELS_ENVIRONMENT_CELLS_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_ENVIRONMENT_CELLS_HPP
#undef HELIOGRAPH_KERNELS_ENVIRONMENT_CELLS_HPP
#else
#define HELIOGRAPH_KERNELS_ENVIRONMENT_CELLS_HPP
#endif

#include <bit>
#include <numbers>
#include <span>

#include "render/kernels/simd/environment.hpp"
#include "render/resources/environment/environment_table.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

struct EnvironmentSample {
  Float3 direction;  // world, unit length
  Float density;     // per steradian
};

class EnvironmentCells {
 public:
  /// `cells`: a grid whose width is a power of two, half as high as wide.
  EnvironmentCells(const shared::FrameConstants& frame, std::span<const EnvironmentCell> cells)
      : frame_(frame),
        cells_(cells.data()),
        count_(static_cast<int>(cells.size())),
        width_bits_((std::countr_zero(cells.size()) + 1) / 2) {}

  /// Draws a cell by `pick` and a point of it, uniform over its solid angle, by `within`.
  HWY_INLINE EnvironmentSample sample(const Float2& pick, const Float2& within) const {
    const Integer drawn =
        hn::Min(truncated(pick.x * number(static_cast<float>(count_))), integer(count_ - 1));
    const Float4 entry = Records(cells_, drawn, sizeof(EnvironmentCell) / 4).four(0);
    const Mask stays = hn::Lt(pick.y, entry.x);
    const Integer cell = select(stays, drawn, as_integer(entry.y));
    const Integer column = hn::And(cell, integer(width() - 1));
    const Integer row = hn::ShiftRightSame(cell, width_bits_);
    constexpr float pi = std::numbers::pi_v<float>;
    const float step = 2.0f * pi / static_cast<float>(width());
    const Float azimuth = hn::MulSub(to_float(column) + within.x, number(step), number(pi));
    const Float top = to_float(row) * number(step);
    const Float cosine = mix(hn::Cos(tag, top), hn::Cos(tag, top + number(step)), within.y);
    const Float sine = hn::Sqrt(at_least(hn::NegMulAdd(cosine, cosine, one()), 0.0f));
    const Float3 own{sine * hn::Cos(tag, azimuth), cosine, sine * hn::Sin(tag, azimuth)};
    return {world_direction(own), select(stays, entry.z, entry.w)};
  }

  /// Of sample() in a world direction, per steradian.
  HWY_INLINE Float density(const Float3& world) const {
    const Float3 d = environment_direction(frame_, world);
    constexpr float by_pi = std::numbers::inv_pi_v<float>;
    const Float u = hn::MulAdd(angle_of(d.x, d.z), number(0.5f * by_pi), number(0.5f));
    const Float v = hn::Acos(tag, clamped(d.y, -1.0f, 1.0f)) * number(by_pi);
    const auto at = [](Float of, int size) HWY_ATTR {
      const Integer index = truncated(of * number(static_cast<float>(size)));
      return hn::Min(hn::Max(index, integer(0)), integer(size - 1));
    };
    const Integer row = hn::ShiftLeftSame(at(v, width() / 2), width_bits_);
    const Integer cell = hn::Add(row, at(u, width()));
    return Records(cells_, cell, sizeof(EnvironmentCell) / 4)
        .real(HELIOGRAPH_WORD(EnvironmentCell, density));
  }

 private:
  int width() const { return 1 << width_bits_; }

  HWY_INLINE Float3 world_direction(const Float3& own) const {
    const Float c = number(frame_.environment_cos), s = number(frame_.environment_sin);
    return {hn::MulAdd(c, own.x, s * own.z), own.y, hn::MulSub(c, own.z, s * own.x)};
  }

  const shared::FrameConstants& frame_;
  const EnvironmentCell* cells_;
  int count_;
  int width_bits_;
};

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
