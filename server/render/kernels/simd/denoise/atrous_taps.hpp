// Where the a-trous filter of a row reads, as shaders/lib/denoise/atrous.glsl has it. Included once
// per instruction set; the guard is Google Highway's convention.
#if defined(HELIOGRAPH_KERNELS_ATROUS_TAPS_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_ATROUS_TAPS_HPP
#undef HELIOGRAPH_KERNELS_ATROUS_TAPS_HPP
#else
#define HELIOGRAPH_KERNELS_ATROUS_TAPS_HPP
#endif

#include <array>
#include <cmath>
#include <vector>

#include "render/kernels/simd/random.hpp"
#include "shaders/shared/denoise.h"
#include "shaders/shared/frame_constants.h"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

struct AtrousTap {
  const float* texels;  // of the area's first pixel, moved by the offset
  float exponent;       // of the kernel's weight against its middle, octaves
  float dx, dy;         // pixels
  float inv_distance;
  float side;  // 1: right or below, -1: left or above
};

struct AtrousTaps {
  int y = -1;
  int count = 0;
  std::array<AtrousTap, 24> taps;
  const AtrousTap* begin() const { return taps.data(); }
  const AtrousTap* end() const { return taps.data() + count; }
};

/// The taps of all pixels of a row that take the same steps.
class AtrousTapRows {
 public:
  AtrousTapRows(const shared::AtrousConstants& constants, const shared::FrameConstants& frame,
                int height, int least_step, int most_step)
      : c_(constants),
        height_(height),
        least_step_(least_step),
        steps_(static_cast<std::size_t>(most_step - least_step + 1)),
        random_(One(), frame.sample_index, 48u + static_cast<unsigned>(constants.level),
                frame.seed) {}

  /// Those of row `y` that are `step` pixels apart; `row` gives the texels of a row.
  template <class Rows>
  const AtrousTaps& at(int step, int y, const Rows& row) {
    AtrousTaps& taps = steps_[static_cast<std::size_t>(step - least_step_)];
    if (taps.y == y) return taps;
    taps.y = y;
    taps.count = 0;
    const int shift_x = c_.columns > 0 ? jitter(step, y).x : 0;
    const int shift_y = c_.rows > 0 ? jitter(step, y).y : 0;
    for (int j = -c_.rows; j <= c_.rows; ++j) {
      const int dy = j * step + shift_y;
      if (y + dy < 0 || y + dy >= height_) continue;
      for (int i = -c_.columns; i <= c_.columns; ++i) {
        if (i == 0 && j == 0) continue;
        const int dx = i * step + shift_x;
        const auto x = static_cast<float>(dx), down = static_cast<float>(dy);
        taps.taps[static_cast<std::size_t>(taps.count++)] = {
            row(y + dy) + dx,
            kernel_exponent(i) + kernel_exponent(j),
            x,
            down,
            1.0f / std::sqrt(x * x + down * down),
            dx + dy > 0 ? 1.0f : -1.0f};
      }
    }
    return taps;
  }

 private:
  using One = hn::FixedTag<std::uint32_t, 1>;

  /// jitter() of the shaders: whole rows move, so that taps stay side by side.
  glm::ivec2 jitter(int step, int y) const {
    if ((c_.flags & shared::atrous_jitter) == 0 || step <= 4) return {0, 0};
    hn::Vec<hn::FixedTag<float, 1>> u, v;
    random_.at(hn::Zero(One()), static_cast<std::uint32_t>(y), u, v);
    const auto shift = [step](float number) {
      return static_cast<int>(std::nearbyint((number - 0.5f) * 0.5f * static_cast<float>(step)));
    };
    return {shift(hn::GetLane(u)), shift(hn::GetLane(v))};
  }

  /// Of the B3 spline (1, 4, 6, 4, 1) / 16 against its middle.
  static float kernel_exponent(int i) {
    constexpr float exponents[] = {0.0f, -0.5849625f, -2.5849625f};
    return exponents[std::abs(i)];
  }

  const shared::AtrousConstants& c_;
  int height_;
  int least_step_;
  std::vector<AtrousTaps> steps_;
  RandomPairs<One> random_;
};

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
