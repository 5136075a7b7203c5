#pragma once

#include <string_view>

#include "render/api/frame_values.hpp"
#include "render/views/buffer_description.hpp"

namespace heliograph::render {

/// What the colours mean, one sentence.
std::string_view legend(ViewColors colors);

/// Largest values are 98th percentiles, so that one outlier does not dim the image.
/// NaNs are black.
Frame colorize(ViewColors colors, const FloatImage& values);

}  // namespace heliograph::render
