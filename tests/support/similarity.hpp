#pragma once

#include "render/api/renderer.hpp"

namespace heliograph::test {

/// Differences of two images of equal size, in the unit of their values; RGB only.
struct Difference {
  double mean = 0.0;     // of the absolute differences
  double maximum = 0.0;  // infinite where a value is not finite
};
Difference difference(const render::FloatImage& a, const render::FloatImage& b);
Difference difference(const render::Frame& a, const render::Frame& b);

/// Structural similarity of luma (Wang et al. 2004): 11 x 11 Gaussian window, sigma 1.5, K1 0.01,
/// K2 0.03, over the pixels whose whole window lies inside. 1: equal.
double ssim(const render::Frame& a, const render::Frame& b);

/// Mean of 0.2126 R + 0.7152 G + 0.0722 B over all pixels.
double mean_luminance(const render::FloatImage& image);

}  // namespace heliograph::test
