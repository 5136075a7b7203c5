#pragma once

#include <vector>

#include "render/api/renderer.hpp"

namespace heliograph::paper {

/// How near pictures come to the truth, over a run of successive frames.
struct Quality {
  double ssim = 0.0;             // mean; of tone-mapped luma
  double luminance_ratio = 0.0;  // mean displayed light, picture / truth
  double flicker = 0.0;          // mean change of the error from frame to frame, in display levels
};

/// Both lists hold the same frames. @throws std::invalid_argument
Quality compare(const std::vector<render::Frame>& frames, const std::vector<render::Frame>& truth);

/// Mean linear light of a displayed picture: sRGB decoded, 0..1.
double displayed_luminance(const render::Frame& frame);

}  // namespace heliograph::paper
