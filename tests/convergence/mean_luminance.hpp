#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/api/renderer.hpp"

namespace heliograph::test {

/// Relative difference of two estimators' means, with its standard error.
struct RelativeDifference {
  double value = 0.0;           // mean of (got - expected) / mean of expected
  double standard_error = 0.0;  // of `value`, from the variance of independent blocks
};

/// Blocks with the same index are paired.
/// @throws std::invalid_argument with fewer than two blocks or unequal counts
RelativeDifference relative_difference(std::span<const double> got,
                                       std::span<const double> expected);

/// Mean luminance of `samples` samples per pixel for each seed in [first, end).
/// @throws std::runtime_error when the settings are rejected or a pixel is not finite
std::vector<double> mean_luminances(render::Renderer& renderer, protocol::Settings settings,
                                    int first, int end, std::uint32_t samples);

}  // namespace heliograph::test
