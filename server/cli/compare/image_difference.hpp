#pragma once

#include <cstdint>
#include <vector>

namespace heliograph::cli {

/// sRGB, RGBA, row 0 on top.
struct ComparedImage {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<std::uint8_t> rgba;
};

/// Structural similarity (Wang et al. 2004): luma, Gaussian windows of 11 pixels, the mean of those
/// that lie inside. 1: equal. Both images have one size; one of less than 11 pixels is one window.
double structural_similarity(const ComparedImage& a, const ComparedImage& b);

/// The differences that are seen when both images alternate, for each pixel from 0 to 1: LDR-FLIP
/// (Andersson et al. 2020), at 67 pixels a degree, which is a display of 0.7 m and 3840 pixels at
/// 0.7 m. Both images have one size.
std::vector<float> flip(const ComparedImage& a, const ComparedImage& b);

}  // namespace heliograph::cli
