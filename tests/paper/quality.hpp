#pragma once

#include <vector>

#include "render/api/renderer.hpp"

namespace heliograph::paper {

/// Quality of consecutive frames against ground truth.
struct Quality {
  double ssim = 0.0;             // mean; of tone-mapped luma
  double luminance_ratio = 0.0;  // mean displayed light, frame / ground truth
  double flicker = 0.0;          // mean change of the error from frame to frame, in display levels
};

/// Both lists hold the same frames. @throws std::invalid_argument
Quality compare(const std::vector<render::Frame>& frames,
                const std::vector<render::Frame>& ground_truth);

/// Mean linear luminance of a displayed frame: sRGB decoded, 0..1.
double displayed_luminance(const render::Frame& frame);

}  // namespace heliograph::paper
