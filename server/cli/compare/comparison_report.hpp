#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cli/compare/image_difference.hpp"

namespace heliograph::cli {

/// One image of both sides.
struct Comparison {
  std::string name;
  ComparedImage first, second;
  double similarity = 1.0;   // SSIM
  double flip = 0.0;         // mean
  std::uint8_t largest = 0;  // difference of a channel
  bool accepted = true;
  std::vector<float> differences;  // FLIP of each pixel
};

/// A page without any other file: images side by side, their differences, figures.
std::string comparison_page(const std::string& first, const std::string& second,
                            const std::vector<Comparison>& comparisons);

}  // namespace heliograph::cli
