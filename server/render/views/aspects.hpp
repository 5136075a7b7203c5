#pragma once

#include "render/views/buffer_description.hpp"

/// Values of aspects: what a channel or two of a texel say.
namespace heliograph::render {

inline glm::vec4 scalar(float value) {
  return {value, 0.0f, 0.0f, 1.0f};
}

template <int channel>
glm::vec4 one_channel(const BufferTexel& texel, const ViewContext&) {
  return scalar(texel.value[channel]);
}

inline glm::vec4 second_pair(const BufferTexel& texel, const ViewContext&) {
  return {texel.value.z, texel.value.w, 0.0f, 0.0f};
}

/// From the texel to the position that it holds, pixels.
inline glm::vec4 offset_to_position(const BufferTexel& texel, const ViewContext&) {
  return {glm::vec2(texel.value) - texel.position, 0.0f, 0.0f};
}

/// Pixels by which a motion vector differs from that of a static scene.
glm::vec4 motion_error(const BufferTexel& texel, const ViewContext& context);

/// Luminance of linear radiance as exposed, in stops from middle grey.
glm::vec4 exposure_stops(const BufferTexel& texel, const ViewContext& context);

}  // namespace heliograph::render
