#include "render/frame/probe.hpp"

#include <algorithm>

#include "render/api/octahedral.hpp"
#include "render/frame/buffer_list.hpp"
#include "render/passes/gbuffer/gbuffer.hpp"
#include "render/passes/post/present.hpp"
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

/// Blends the mean into the frame's own radiance by its weight in x of `weights`, as present()
/// does; alpha is 1.
void mix(FloatImage& own, const FloatImage& mean, const FloatImage& weights) {
  for (std::size_t i = 0; i < own.rgba.size(); ++i) {
    const float weight = weights.rgba[i / 4 * 4];
    float value = weight < 1.0f ? own.rgba[i] : 0.0f;
    if (weight > 0.0f) value += (mean.rgba[i] - value) * weight;
    own.rgba[i] = i % 4 == 3 ? 1.0f : std::max(value, 0.0f);
  }
}

}  // namespace

FloatImage shown_radiance(const CompiledFrame& compiled) {
  const auto read = [&](gpu::ImageRef ref) {
    const auto [image, drawn] = compiled.latest(ref);
    return read_image(image, drawn);
  };
  FloatImage radiance = read(compiled.outputs.radiance);
  FloatImage mean = read(compiled.outputs.mean);
  // Frames that are reconstructed from smaller ones show none of the mean, which is as small.
  if (mean.rgba.size() != radiance.rgba.size()) mean = radiance;
  mix(radiance, mean, read(compiled.outputs.mean_weight));
  return radiance;
}

std::vector<BufferValue> inspect_buffers(const CompiledFrame& compiled, const ViewContext& context,
                                         glm::vec2 point) {
  std::vector<BufferValue> values;
  for (const BufferInfo& buffer : compiled.buffers) {
    if (buffer.name == present_buffers.radiance.name) {
      const auto read = [&](gpu::ImageRef ref) {
        const auto [image, drawn] = compiled.latest(ref);
        const glm::uvec2 pixel = pixel_at(point, drawn);
        return read_texel(image, pixel.x, pixel.y);
      };
      FloatImage value = read(compiled.outputs.radiance);
      mix(value, read(compiled.outputs.mean), read(compiled.outputs.mean_weight));
      values.push_back({buffer.name, std::move(value.rgba), {}});
      continue;
    }
    const View view = find_view(buffer.name);
    const auto image = compiled.find(view.buffer->name);
    if (!image) continue;
    const glm::uvec2 pixel = pixel_at(point, image->drawn);
    FloatImage value = read_texel(image->whole, pixel.x, pixel.y);
    value = extract(view, value, context, pixel);
    value.rgba.resize(value.channels);
    values.push_back({buffer.name, std::move(value.rgba), std::string(view.unit())});
  }
  return values;
}

protocol::Result<std::optional<SurfacePoint>> surface_at(const CompiledFrame& compiled,
                                                         const shared::FrameConstants& frame,
                                                         glm::vec2 point) {
  const auto instances = compiled.find(gbuffer_buffers.instance.name);
  const auto motion = compiled.find(gbuffer_buffers.motion.name);
  const auto normals = compiled.find(gbuffer_buffers.normals.name);
  if (!instances || !motion || !normals) {
    return protocol::error::conflict(
        "reference.use", "is on: the path traced reference image has no surfaces to pick");
  }
  const glm::uvec2 pixel = pixel_at(point, instances->drawn);
  const auto instance = static_cast<std::uint32_t>(texel(instances->whole, pixel).x);
  const float view_z = texel(motion->whole, pixel).w;
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
  const glm::vec4 encoded = texel(normals->whole, pixel);
  surface.normal = octahedral_decode({encoded.z, encoded.w});
  const glm::vec3 toward_eye =
      orthographic ? glm::vec3(frame.inverse_view[2]) : glm::vec3(frame.eye) - surface.position;
  if (glm::dot(surface.normal, toward_eye) < 0.0f) surface.normal = -surface.normal;
  return std::optional(surface);
}

}  // namespace heliograph::render
