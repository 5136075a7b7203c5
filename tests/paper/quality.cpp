#include "tests/paper/quality.hpp"

#include <array>
#include <cmath>
#include <stdexcept>

#include "tests/support/similarity.hpp"

namespace heliograph::paper {
namespace {

std::array<double, 256> make_srgb_table() {
  std::array<double, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double value = static_cast<double>(i) / 255.0;
    table[i] = value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
  }
  return table;
}

/// Mean absolute change of (frame - ground truth) between consecutive frames.
double change_of_error(const render::Frame& before, const render::Frame& ground_truth_before,
                       const render::Frame& now, const render::Frame& truth_now) {
  double sum = 0.0;
  for (std::size_t i = 0; i < now.rgba.size(); ++i) {
    if (i % 4 == 3) continue;
    const int error_before = int(before.rgba[i]) - int(ground_truth_before.rgba[i]);
    const int error_now = int(now.rgba[i]) - int(truth_now.rgba[i]);
    sum += std::abs(error_now - error_before);
  }
  return sum / static_cast<double>(now.rgba.size() / 4 * 3);
}

}  // namespace

double displayed_luminance(const render::Frame& frame) {
  static const std::array<double, 256> linear = make_srgb_table();
  double sum = 0.0;
  for (std::size_t i = 0; i < frame.rgba.size(); i += 4) {
    const auto* rgb = &frame.rgba[i];
    sum += 0.2126 * linear[rgb[0]] + 0.7152 * linear[rgb[1]] + 0.0722 * linear[rgb[2]];
  }
  return sum / static_cast<double>(frame.rgba.size() / 4);
}

Quality compare(const std::vector<render::Frame>& frames,
                const std::vector<render::Frame>& ground_truth) {
  if (frames.size() != ground_truth.size() || frames.size() < 2) {
    throw std::invalid_argument("at least two frames and as many ground truth frames are required");
  }
  Quality quality;
  double light = 0.0;
  double true_light = 0.0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    quality.ssim += test::ssim(frames[i], ground_truth[i]);
    light += displayed_luminance(frames[i]);
    true_light += displayed_luminance(ground_truth[i]);
    if (i == 0) continue;
    quality.flicker +=
        change_of_error(frames[i - 1], ground_truth[i - 1], frames[i], ground_truth[i]);
  }
  quality.ssim /= static_cast<double>(frames.size());
  quality.flicker /= static_cast<double>(frames.size() - 1);
  quality.luminance_ratio = true_light > 0.0 ? light / true_light : 0.0;
  return quality;
}

}  // namespace heliograph::paper
