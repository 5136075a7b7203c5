#include "render/frame/probe.hpp"

#include <algorithm>
#include <cmath>

#include "render/api/octahedral.hpp"
#include "render/frame/buffer_list.hpp"
#include "render/passes/gbuffer/gbuffer.hpp"
#include "render/passes/post/mean_weight.hpp"
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

/// What a point of the frame sees, in view space.
struct ViewRay {
  glm::vec3 origin, direction;  // direction: per metre of depth

  glm::vec3 at(float depth) const { return origin + depth * direction; }
};

/// `offset`: of the sample within the pixel; zero for a point of the image that is shown.
ViewRay view_ray(const shared::FrameConstants& frame, glm::vec2 point, glm::vec2 offset) {
  const glm::vec2 scale(frame.unproject);
  const glm::vec2 across = (point * 2.0f - 1.0f) * scale + offset;
  if ((frame.flags & shared::frame_orthographic) != 0) {
    return {glm::vec3(across, 0.0f), glm::vec3(0.0f, 0.0f, -1.0f)};
  }
  return {glm::vec3(0.0f), glm::vec3(across, -1.0f)};
}

/// Where `ray` meets the plane through `sample`, the surface that the pixel shows, so that a point
/// within a large pixel is as exact as the surface is flat. Where the plane is seen edge on, the
/// sample's depth stays.
glm::vec3 on_surface(const ViewRay& ray, glm::vec3 sample, glm::vec3 normal) {
  constexpr float most_change = 0.1f;  // of the depth, within a pixel
  const float depth = glm::dot(normal, sample - ray.origin) / glm::dot(normal, ray.direction);
  const bool plausible = std::abs(depth + sample.z) <= -most_change * sample.z;  // false for NaN
  return ray.at(plausible ? depth : -sample.z);
}

/// Blends the mean into the frame's own radiance by its weight in x of `weights`, where not all
/// pixels have the same, as present() does; alpha is 1.
void mix(FloatImage& own, const FloatImage& mean, const FloatImage& weights,
         std::optional<float> uniform_weight) {
  for (std::size_t i = 0; i < own.rgba.size(); ++i) {
    const float weight = uniform_weight ? *uniform_weight : weights.rgba[i / 4 * 4];
    float value = weight < 1.0f ? own.rgba[i] : 0.0f;
    if (weight > 0.0f) value += (mean.rgba[i] - value) * weight;
    own.rgba[i] = i % 4 == 3 ? 1.0f : std::max(value, 0.0f);
  }
}

}  // namespace

void fill_in_weight(const CompiledFrame& compiled, std::string_view buffer, FloatImage& values) {
  if (!compiled.uniform_weight || buffer != mean_weight_buffers.weight.name) return;
  for (std::size_t i = 0; i < values.rgba.size(); i += 4) {
    values.rgba[i] = *compiled.uniform_weight;
  }
}

FloatImage shown_radiance(const CompiledFrame& compiled) {
  const auto read = [&](gpu::ImageRef ref) {
    const auto [image, drawn] = compiled.latest(ref);
    return read_image(image, drawn);
  };
  FloatImage radiance = read(compiled.outputs.radiance);
  FloatImage mean = read(compiled.outputs.mean);
  // Frames that are reconstructed from smaller ones show none of the mean, which is as small.
  if (mean.rgba.size() != radiance.rgba.size()) mean = radiance;
  mix(radiance, mean, read(compiled.outputs.mean_weight), compiled.uniform_weight);
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
      mix(value, read(compiled.outputs.mean), read(compiled.outputs.mean_weight),
          compiled.uniform_weight);
      values.push_back({buffer.name, std::move(value.rgba), {}});
      continue;
    }
    const View view = find_view(buffer.name);
    const auto image = compiled.find(view.buffer->name);
    if (!image) continue;
    const glm::uvec2 pixel = pixel_at(point, image->drawn);
    FloatImage value = read_texel(image->whole, pixel.x, pixel.y);
    fill_in_weight(compiled, view.buffer->name, value);
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
  const glm::vec4 encoded = texel(normals->whole, pixel);
  glm::vec3 normal = octahedral_decode({encoded.z, encoded.w});
  // The histories may have been rescaled since the frame: their size counts, not the frame's.
  const glm::vec2 drawn(instances->drawn.width, instances->drawn.height);
  const glm::vec2 centre = (glm::vec2(pixel) + 0.5f) / drawn;
  const glm::vec2 jitter(frame.unproject.z, frame.unproject.w);
  const glm::vec3 sample = view_ray(frame, centre, jitter).at(view_z);
  const glm::mat3 to_view = glm::transpose(glm::mat3(frame.inverse_view));
  const glm::vec3 in_view =
      on_surface(view_ray(frame, point, glm::vec2(0.0f)), sample, to_view * normal);
  const glm::vec3 position(frame.inverse_view * glm::vec4(in_view, 1.0f));
  const glm::vec3 toward_eye =
      orthographic ? glm::vec3(frame.inverse_view[2]) : glm::vec3(frame.eye) - position;
  if (glm::dot(normal, toward_eye) < 0.0f) normal = -normal;
  return std::optional(SurfacePoint{.instance = instance - 1,
                                    .position = position,
                                    .normal = normal,
                                    .distance = orthographic ? -in_view.z : glm::length(in_view)});
}

}  // namespace heliograph::render
