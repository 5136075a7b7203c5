#include "render/kernels/post/outline.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "render/kernels/common/parallel.hpp"

namespace heliograph::render::kernels {
namespace {

constexpr int taps = 6;

/// The drawn columns, or rows, around the centre of a shown one, and their shares.
struct Footprint {
  int first;
  std::array<float, taps> weights;
};

/// Of every shown column or row. Samples beyond the image count as those at its edge.
std::vector<Footprint> footprints(std::uint32_t shown, std::uint32_t drawn, float offset) {
  std::vector<Footprint> all(shown);
  const float step = static_cast<float>(drawn) / static_cast<float>(shown);
  for (std::uint32_t i = 0; i < shown; ++i) {
    const float centre = (static_cast<float>(i) + 0.5f) * step - offset - 0.5f;
    all[i].first = static_cast<int>(std::floor(centre)) - taps / 2 + 1;
    float sum = 0.0f;
    for (int tap = 0; tap < taps; ++tap) {
      const float distance = static_cast<float>(all[i].first + tap) - centre;
      sum += all[i].weights[static_cast<std::size_t>(tap)] = std::exp(-0.5f * distance * distance);
    }
    for (float& weight : all[i].weights) weight /= sum;
  }
  return all;
}

class Outline {
 public:
  explicit Outline(const OutlineJob& job)
      : job_(job),
        columns_(footprints(job.constants.shown.x, job.constants.drawn.x,
                            job.constants.sample_offset.x)),
        rows_(footprints(job.constants.shown.y, job.constants.drawn.y,
                         job.constants.sample_offset.y)) {}

  void rows(int first, int last) const {
    const auto width = static_cast<std::size_t>(job_.constants.shown.x);
    const int from = rows_[static_cast<std::size_t>(first)].first;
    const int to = rows_[static_cast<std::size_t>(last - 1)].first + taps;
    std::vector<float> blurred(static_cast<std::size_t>(to - from) * width);
    std::vector<bool> any;
    for (int row = from; row < to; ++row) {
      any.push_back(blur(row, blurred.data() + static_cast<std::size_t>(row - from) * width));
    }
    for (int y = first; y < last; ++y) {
      const Footprint& footprint = rows_[static_cast<std::size_t>(y)];
      const auto top = static_cast<std::size_t>(footprint.first - from);
      if (std::none_of(any.begin() + static_cast<std::ptrdiff_t>(top),
                       any.begin() + static_cast<std::ptrdiff_t>(top) + taps,
                       [](bool one) { return one; })) {
        continue;
      }
      draw(y, footprint, blurred.data() + top * width);
    }
  }

 private:
  bool selected(std::uint32_t instance) const {
    if (instance == 0) return false;
    return job_.selection[(instance - 1) / 32] >> ((instance - 1) % 32) & 1u;
  }

  /// One drawn row along its length. @return whether anything in it is selected
  bool blur(int row, float* to) const {
    const int width = static_cast<int>(job_.constants.drawn.x);
    const int height = static_cast<int>(job_.constants.drawn.y);
    const auto* const ids = job_.instance.row<const std::uint32_t>(
        static_cast<std::uint32_t>(std::clamp(row, 0, height - 1)));
    std::vector<float> covered(static_cast<std::size_t>(width));
    bool any = false, inside = false;
    std::uint32_t before = 0;
    for (int x = 0; x < width; ++x) {
      if (ids[x] != before) inside = selected(before = ids[x]);
      covered[static_cast<std::size_t>(x)] = inside ? 1.0f : 0.0f;
      any |= inside;
    }
    if (!any) return false;
    for (std::size_t x = 0; x < columns_.size(); ++x) {
      for (int tap = 0; tap < taps; ++tap) {
        const int column = std::clamp(columns_[x].first + tap, 0, width - 1);
        to[x] += columns_[x].weights[static_cast<std::size_t>(tap)] *
                 covered[static_cast<std::size_t>(column)];
      }
    }
    return true;
  }

  void draw(int y, const Footprint& footprint, const float* blurred) const {
    const std::size_t width = columns_.size();
    auto* const pixels = job_.output.row<std::uint8_t>(static_cast<std::uint32_t>(y));
    for (std::size_t x = 0; x < width; ++x) {
      float coverage = 0.0f;
      for (std::size_t tap = 0; tap < taps; ++tap) {
        coverage += footprint.weights[tap] * blurred[tap * width + x];
      }
      const float share = 4.0f * coverage * (1.0f - coverage);
      if (share <= 0.0f) continue;
      for (int channel = 0; channel < 3; ++channel) {
        std::uint8_t& value = pixels[4 * x + static_cast<std::size_t>(channel)];
        const float from = static_cast<float>(value), to = 255.0f * job_.constants.color[channel];
        value = static_cast<std::uint8_t>(std::lround(from + share * (to - from)));
      }
    }
  }

  const OutlineJob& job_;
  std::vector<Footprint> columns_;
  std::vector<Footprint> rows_;
};

}  // namespace

void outline(const OutlineJob& job) {
  constexpr int rows_at_once = 32;
  const Outline outline(job);
  for_each_range(static_cast<int>(job.constants.shown.y), rows_at_once,
                 [&](int first, int last) { outline.rows(first, last); });
}

}  // namespace heliograph::render::kernels
