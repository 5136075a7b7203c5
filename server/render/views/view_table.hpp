#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "render/views/view_colors.hpp"
#include "shaders/shared/frame_constants.h"

namespace heliograph::render {

/// The colours that suit a view, by its name: radiance where the name says nothing.
ViewColors colors_of(std::string_view view);

/// What its values are and in which unit; empty where the name says nothing.
std::string_view description_of(std::string_view view);

/// Views of their own of what lies in some channels of a buffer: "gbuffer.motion.view_z".
std::vector<std::string> aspects_of(std::string_view buffer);

/// The buffer that a view shows an aspect of; empty: the view is a buffer itself.
std::string_view source_of(std::string_view view);

/// What an aspect needs besides the buffer.
struct ViewContext {
  const shared::FrameConstants& constants;
  float exposure_factor;
};

/// Unit of a view's values; empty: plain numbers, or channels of different kinds.
std::string_view unit_of(std::string_view view);

/// An aspect's values, from those of its source, which may be a part of the picture that begins at
/// the pixel `origin`.
FloatImage extract(std::string_view view, const FloatImage& source, const ViewContext& context,
                   glm::uvec2 origin = glm::uvec2(0u));

}  // namespace heliograph::render
