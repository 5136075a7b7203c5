#pragma once

#include <string_view>

#include "render/api/frame_values.hpp"

namespace heliograph::render {

/// How a buffer's values become colours for people.
enum class ViewColors {
  picture,     // sRGB as it is
  radiance,    // Reinhard's curve: every value stays visible
  squared,     // linear colour stored as its square root
  channels,    // red, green and blue as they are
  grey,        // x
  direction,   // unit vector xyz; none is black
  octahedral,  // unit vector as octahedral xy
  difference,  // x and y about grey, to the frame's own largest
  identity,    // whole numbers: another colour for each, 0 black
  share,       // heat, 0..1
  heat,        // heat, 0 to the frame's own largest
  deviation,   // heat of the larger of sqrt(x), sqrt(y), 0 to the frame's own largest
  distance,    // heat of the logarithm, within the frame's own range; 0 is black
  stops,       // heat, -8..8
  pixels,      // heat, 0 to the frame's own largest but at least a tenth
  mark         // x > 0.5 red, else dark
};

/// What the colours mean, one sentence.
std::string_view legend(ViewColors colors);

/// Largest values are 98th percentiles, lest one outlier dim everything. What is not a number shows
/// black.
Frame colorize(ViewColors colors, const FloatImage& values);

}  // namespace heliograph::render
