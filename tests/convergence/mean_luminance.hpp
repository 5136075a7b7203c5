#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/api/renderer.hpp"

namespace heliograph::test {

/// How far one estimator's mean lies from another's, and how well that is known.
struct RelativeDifference {
  double value = 0.0;           // mean of (got - expected) / mean of expected
  double standard_error = 0.0;  // of `value`, from how much independent blocks differ
};

/// Blocks of the same number belong together.
/// @throws std::invalid_argument with fewer than two blocks, or unequally many
RelativeDifference relative_difference(std::span<const double> got,
                                       std::span<const double> expected);

/// Mean luminance of `samples` per pixel for each seed of the random sequences from `first` to
/// before `end`.
/// @throws std::runtime_error when the settings are refused or a pixel is no number
std::vector<double> mean_luminances(render::Renderer& renderer, protocol::Settings settings,
                                    int first, int end, std::uint32_t samples);

}  // namespace heliograph::test
