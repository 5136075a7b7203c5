#pragma once

#include <string_view>

#include "render/api/frame_values.hpp"
#include "render/views/buffer_description.hpp"

namespace heliograph::render {

/// What the colours mean, one sentence.
std::string_view legend(ViewColors colors);

/// Largest values are 98th percentiles, lest one outlier dim everything. NaNs are
/// black.
Frame colorize(ViewColors colors, const FloatImage& values);

}  // namespace heliograph::render
