#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string_view>

#include "shaders/shared/frame_constants.h"

namespace heliograph::render {

/// How a buffer's values become colours.
enum class ViewColors {
  output,      // sRGB as it is
  radiance,    // Reinhard's curve: every value stays visible
  squared,     // linear colour stored as its square root
  channels,    // red, green and blue as they are
  grey,        // x
  direction,   // unit vector xyz; none is black
  octahedral,  // unit vector as octahedral xy
  difference,  // x and y about grey, to the frame's own largest
  identity,    // whole numbers: another colour for each, 0 black
  fraction,    // heat, 0..1
  heat,        // heat, 0 to the frame's own largest
  deviation,   // heat of the larger of sqrt(x), sqrt(y), 0 to the frame's own largest
  distance,    // heat of the logarithm, within the frame's own range; 0 is black
  stops,       // heat, -8..8
  pixels,      // heat, 0 to the frame's own largest but at least a tenth
  mark         // x > 0.5 red, else dark
};

/// One texel of a buffer.
struct BufferTexel {
  glm::vec4 value;
  glm::vec2 position;  // its centre, in pixels
};

/// What an aspect needs besides the buffer.
struct ViewContext {
  const shared::FrameConstants& constants;
  float exposure_factor;
};

/// A view of its own of some channels of a buffer: "gbuffer.motion.view_z".
struct Aspect {
  std::string_view name;  // after the buffer's and a dot
  ViewColors colors;
  std::uint32_t channels;
  glm::vec4 (*extract)(const BufferTexel&, const ViewContext&);
  std::string_view description;
  std::string_view unit = {};
};

/// An image of the frame that a view or a capture may name. Tables of these stand beside the passes
/// that write the images; all of them are listed in render/frame/buffer_list.cpp.
struct BufferDescription {
  std::string_view name;
  ViewColors colors;
  std::string_view description;  // what its values are
  std::string_view unit = {};    // empty: plain numbers, or channels of different kinds
  std::span<const Aspect> aspects = {};
};

}  // namespace heliograph::render
