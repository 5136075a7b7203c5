#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "render/api/frame_values.hpp"
#include "render/views/buffer_description.hpp"

/// Views by name: buffers, which the passes describe, and their aspects.
namespace heliograph::render {

/// A buffer, or an aspect of one. Both null: there is no view of that name.
struct View {
  const BufferDescription* buffer = nullptr;
  const Aspect* aspect = nullptr;

  explicit operator bool() const { return buffer != nullptr; }
  ViewColors colors() const { return aspect ? aspect->colors : buffer->colors; }
  std::string_view description() const {
    return aspect ? aspect->description : buffer->description;
  }
  std::string_view unit() const { return aspect ? aspect->unit : buffer->unit; }
};
View find_view(std::string_view name);

/// Names of a buffer's aspects: "gbuffer.motion.view_z".
std::vector<std::string> aspect_names(const BufferDescription& buffer);

/// A view's values, from those of its buffer, which may be a part of the image that begins at the
/// pixel `origin`.
FloatImage extract(const View& view, const FloatImage& buffer, const ViewContext& context,
                   glm::uvec2 origin = glm::uvec2(0u));

/// A view's values as an image (paper section 3, stage 9): every kind of signal in the colours that
/// suit it, sRGB RGBA8. Depths and motion are scaled to the frame's own range.
Frame visualise(std::string_view view, const FloatImage& values);

}  // namespace heliograph::render
