#include "render/frame/probe.hpp"

#include <algorithm>

#include "render/api/octahedral.hpp"
#include "render/views/debug_view.hpp"

namespace heliograph::render {
namespace {

glm::uvec2 pixel_at(glm::vec2 point, VkExtent2D extent) {
  const glm::vec2 size(extent.width, extent.height);
  const glm::vec2 last = size - 1.0f;
  return glm::uvec2(glm::clamp(glm::floor(point * size), glm::vec2(0.0f), last));
}

glm::vec4 texel(const gpu::Image& image, glm::uvec2 pixel) {
  const std::vector<float> value = read_texel(image, pixel.x, pixel.y).rgba;
  return {value[0], value[1], value[2], value[3]};
}

/// The frame's own radiance turned into what the picture is made from; alpha is 1.
void mix(FloatImage& own, const FloatImage& mean, float share_of_mean) {
  for (std::size_t i = 0; i < own.rgba.size(); ++i) {
    float value = share_of_mean < 1.0f ? own.rgba[i] : 0.0f;
    if (share_of_mean > 0.0f) value += (mean.rgba[i] - value) * share_of_mean;
    own.rgba[i] = i % 4 == 3 ? 1.0f : std::max(value, 0.0f);
  }
}

}  // namespace

FloatImage shown_radiance(const Drawing& drawing, float share_of_mean) {
  FloatImage radiance = read_image(drawing.plan.latest(drawing.outputs.radiance));
  mix(radiance, read_image(drawing.plan.latest(drawing.outputs.accumulated.current)),
      share_of_mean);
  return radiance;
}

std::vector<BufferValue> inspect_buffers(const Drawing& drawing, const ViewContext& context,
                                         float share_of_mean, glm::vec2 point) {
  std::vector<BufferValue> values;
  for (const BufferInfo& buffer : drawing.buffers) {
    if (buffer.name == radiance_name) {
      const gpu::Image& image = drawing.plan.latest(drawing.outputs.radiance);
      const gpu::Image& mean = drawing.plan.latest(drawing.outputs.accumulated.current);
      const glm::uvec2 pixel = pixel_at(point, image.desc().extent);
      FloatImage value = read_texel(image, pixel.x, pixel.y);
      mix(value, read_texel(mean, pixel.x, pixel.y), share_of_mean);
      values.push_back({buffer.name, std::move(value.rgba), {}});
      continue;
    }
    const std::string_view source = source_of(buffer.name);
    const gpu::Image* const image = drawing.find(source.empty() ? buffer.name : source);
    if (!image) continue;
    const glm::uvec2 pixel = pixel_at(point, image->desc().extent);
    FloatImage value = read_texel(*image, pixel.x, pixel.y);
    if (!source.empty()) value = extract(buffer.name, value, context, pixel);
    value.rgba.resize(value.channels);
    values.push_back({buffer.name, std::move(value.rgba), std::string(unit_of(buffer.name))});
  }
  return values;
}

protocol::Result<std::optional<SurfacePoint>> surface_at(const Drawing& drawing,
                                                         const shared::FrameConstants& frame,
                                                         glm::vec2 point) {
  const gpu::Image* const instances = drawing.find("gbuffer.instance");
  const gpu::Image* const motion = drawing.find("gbuffer.motion");
  const gpu::Image* const normals = drawing.find("gbuffer.normals");
  if (!instances || !motion || !normals) {
    return protocol::error::conflict(
        "reference.use", "is on: the path traced reference image has no surfaces to pick");
  }
  const glm::uvec2 pixel = pixel_at(point, instances->desc().extent);
  const auto instance = static_cast<std::uint32_t>(texel(*instances, pixel).x);
  const float view_z = texel(*motion, pixel).w;
  if (instance == 0 || view_z <= 0.0f) return std::optional<SurfacePoint>();

  const bool orthographic = (frame.flags & shared::frame_orthographic) != 0;
  const glm::vec2 ndc = (glm::vec2(pixel) + 0.5f) / glm::vec2(frame.extent) * 2.0f - 1.0f;
  const glm::vec4& unproject = frame.unproject;
  glm::vec2 across = ndc * glm::vec2(unproject) + glm::vec2(unproject.z, unproject.w);
  if (!orthographic) across *= view_z;
  const glm::vec3 in_view(across, -view_z);
  SurfacePoint surface{.instance = instance - 1,
                       .position = glm::vec3(frame.inverse_view * glm::vec4(in_view, 1.0f)),
                       .normal = {},
                       .distance = orthographic ? view_z : glm::length(in_view)};
  const glm::vec4 encoded = texel(*normals, pixel);
  surface.normal = octahedral_decode({encoded.z, encoded.w});
  const glm::vec3 toward_eye =
      orthographic ? glm::vec3(frame.inverse_view[2]) : glm::vec3(frame.eye) - surface.position;
  if (glm::dot(surface.normal, toward_eye) < 0.0f) surface.normal = -surface.normal;
  return std::optional(surface);
}

}  // namespace heliograph::render
