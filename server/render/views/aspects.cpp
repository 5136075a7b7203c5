#include "render/views/aspects.hpp"

#include <cmath>

#include "shaders/shared/exposure.h"

namespace heliograph::render {

glm::vec4 motion_error(const BufferTexel& texel, const ViewContext& context) {
  const shared::FrameConstants& frame = context.constants;
  const float view_z = texel.value.w;
  if (view_z <= 0.0f) return scalar(0.0f);
  const glm::vec2 size(frame.extent);
  const glm::vec2 ndc = texel.position / size * 2.0f - 1.0f;
  const glm::vec4& unproject = frame.unproject;
  glm::vec2 slope = ndc * glm::vec2(unproject) + glm::vec2(unproject.z, unproject.w);
  if ((frame.flags & shared::frame_orthographic) == 0) slope *= view_z;
  const glm::vec4 world = frame.inverse_view * glm::vec4(slope, -view_z, 1.0f);
  const glm::vec4 before = frame.previous_unjittered * world, now = frame.unjittered * world;
  const glm::vec2 of_camera = (glm::vec2(before) / before.w - glm::vec2(now) / now.w) * 0.5f;
  return scalar(glm::length((glm::vec2(texel.value) - of_camera) * size));
}

glm::vec4 exposure_stops(const BufferTexel& texel, const ViewContext& context) {
  const float light = glm::dot(glm::vec3(texel.value), glm::vec3(0.2126f, 0.7152f, 0.0722f));
  const float shown = light * context.exposure_factor / shared::exposure_middle_grey;
  return scalar(std::log2(std::max(shown, 1e-12f)));
}

}  // namespace heliograph::render
