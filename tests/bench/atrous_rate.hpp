#pragma once

#include <cstdint>

namespace heliograph::bench {

/// One half of a separable iteration of the a-trous filter as a bare loop: guide and signal lie in
/// planes, all taps are inside the frame and `step` pixels apart, and nothing depends on settings.
/// What the host kernels' passes are measured by.
/// @return milliseconds on all processors, medians of several runs; mean of across and down
double atrous_milliseconds(bool visibility, std::uint32_t width, std::uint32_t height, int step);

}  // namespace heliograph::bench
