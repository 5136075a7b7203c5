#include "render/views/view_table.hpp"

#include <array>
#include <cmath>

#include "shaders/shared/exposure.h"

namespace heliograph::render {
namespace {

/// `*` stands for anything; there is at most one.
bool matches(std::string_view name, std::string_view pattern) {
  const std::size_t star = pattern.find('*');
  if (star == std::string_view::npos) return name == pattern;
  return name.size() + 1 >= pattern.size() && name.starts_with(pattern.substr(0, star)) &&
         name.ends_with(pattern.substr(star + 1));
}

struct Pixel {
  glm::vec4 value;
  glm::vec2 position;  // its middle, in pixels
};

struct BufferRule {
  std::string_view pattern;
  ViewColors colors;
  std::string_view description = {};  // empty: what its pass says
  std::string_view unit = {};
};

// The first that matches counts.
constexpr std::array buffer_rules{
    BufferRule{"output", ViewColors::picture},
    BufferRule{"gbuffer.normals", ViewColors::octahedral,
               "Normals in world space, octahedral: shading (xy), geometric (zw)."},
    BufferRule{"gbuffer.base_color", ViewColors::squared,
               "Square root of the linear base colour; occlusion texture (w)."},
    BufferRule{"gbuffer.surface", ViewColors::channels,
               "Perceptual roughness, metalness, 1 where unlit."},
    BufferRule{"gbuffer.motion", ViewColors::difference,
               "From each point to where it was one frame ago: shares of the picture's width and "
               "height, view Z in metres; view Z now (w)."},
    BufferRule{"gbuffer.emissive", ViewColors::radiance, "Radiance that surfaces give off."},
    BufferRule{"gbuffer.depth_slope", ViewColors::difference,
               "Change of view Z to the pixel on the right and below, metres.", "metres"},
    BufferRule{"gbuffer.instance", ViewColors::identity, "Instance + 1."},
    BufferRule{"shadows.visibility", ViewColors::grey,
               "Share of the lights' light that one ray per pixel finds unshadowed."},
    BufferRule{"ambient.visibility", ViewColors::grey,
               "Share of the surroundings that one ray per pixel finds open."},
    BufferRule{"specular.radiance", ViewColors::radiance,
               "What one mirrored ray per pixel brings, without the surface's colour; its length "
               "in metres (w)."},
    BufferRule{"blended.radiance", ViewColors::radiance,
               "Light of blended surfaces, as far as it reaches the eye; linear."},
    BufferRule{"blended.behind", ViewColors::channels,
               "How much of what lies behind them blended surfaces let show."},
    BufferRule{"blended.motion", ViewColors::difference,
               "Like gbuffer.motion, of the surface that shows most."},
    BufferRule{"blended.mirrored", ViewColors::radiance,
               "What one mirrored ray per pixel brings to blended surfaces; linear."},
    BufferRule{"blended.surface", ViewColors::channels,
               "Perceptual roughness and metalness of the blended surface that rays light."},
    BufferRule{"skybox", ViewColors::radiance, "Radiance of the environment behind the scene."},
    BufferRule{"hdr", ViewColors::radiance,
               "The frame's radiance, without noise, before "
               "antialiasing: linear."},
    BufferRule{"hdr_raw", ViewColors::radiance, "The frame's radiance with its noise: linear."},
    BufferRule{"reference", ViewColors::radiance,
               "One sample of the path tracer: linear radiance."},
    BufferRule{"*.visibility", ViewColors::grey},
    BufferRule{"*.history", ViewColors::heat},
    BufferRule{"*.moments", ViewColors::channels},
    BufferRule{"visibility.*", ViewColors::channels},
    BufferRule{"*.directions", ViewColors::direction},
    BufferRule{"denoise.guide", ViewColors::direction},
    BufferRule{"denoise.reprojection", ViewColors::heat},
};

struct AspectRule {
  std::string_view buffer;  // pattern
  std::string_view name;
  ViewColors colors;
  std::uint32_t channels;
  glm::vec4 (*extract)(const Pixel&, const ViewContext&);
  std::string_view description;
  std::string_view unit = {};
};

glm::vec4 scalar(float value) {
  return {value, 0.0f, 0.0f, 1.0f};
}

template <int channel>
glm::vec4 take(const Pixel& pixel, const ViewContext&) {
  return scalar(pixel.value[channel]);
}

glm::vec4 second_pair(const Pixel& pixel, const ViewContext&) {
  return {pixel.value.z, pixel.value.w, 0.0f, 0.0f};
}

glm::vec4 offset(const Pixel& pixel, const ViewContext&) {
  return {glm::vec2(pixel.value) - pixel.position, 0.0f, 0.0f};
}

/// Pixels by which the motion differs from that of a scene at rest.
glm::vec4 motion_error(const Pixel& pixel, const ViewContext& context) {
  const shared::FrameConstants& frame = context.constants;
  const float view_z = pixel.value.w;
  if (view_z <= 0.0f) return scalar(0.0f);
  const glm::vec2 size(frame.extent);
  const glm::vec2 ndc = pixel.position / size * 2.0f - 1.0f;
  const glm::vec4& unproject = frame.unproject;
  glm::vec2 slope = ndc * glm::vec2(unproject) + glm::vec2(unproject.z, unproject.w);
  if ((frame.flags & shared::frame_orthographic) == 0) slope *= view_z;
  const glm::vec4 world = frame.inverse_view * glm::vec4(slope, -view_z, 1.0f);
  const glm::vec4 before = frame.previous_unjittered * world, now = frame.unjittered * world;
  const glm::vec2 rest = (glm::vec2(before) / before.w - glm::vec2(now) / now.w) * 0.5f;
  return scalar(glm::length((glm::vec2(pixel.value) - rest) * size));
}

glm::vec4 stops(const Pixel& pixel, const ViewContext& context) {
  const float light = glm::dot(glm::vec3(pixel.value), glm::vec3(0.2126f, 0.7152f, 0.0722f));
  const float shown = light * context.exposure_factor / shared::exposure_middle_grey;
  return scalar(std::log2(std::max(shown, 1e-12f)));
}

constexpr std::array aspect_rules{
    AspectRule{"gbuffer.normals", "geometric", ViewColors::octahedral, 2, second_pair,
               "Normals of the triangles themselves, octahedral, world space."},
    AspectRule{"gbuffer.base_color", "occlusion", ViewColors::share, 1, take<3>,
               "Occlusion texture, 0..1."},
    AspectRule{"gbuffer.surface", "roughness", ViewColors::share, 1, take<0>,
               "Perceptual roughness, 0..1."},
    AspectRule{"gbuffer.surface", "metallic", ViewColors::share, 1, take<1>, "Metalness, 0..1."},
    AspectRule{"gbuffer.motion", "view_z", ViewColors::distance, 1, take<3>,
               "Distance along the view, metres.", "metres"},
    AspectRule{"gbuffer.motion", "error", ViewColors::pixels, 1, motion_error,
               "How far the motion is from what it would be if only the camera moved, pixels.",
               "pixels"},
    AspectRule{"visibility.temporal", "noise", ViewColors::deviation, 2, second_pair,
               "Standard deviation before the blur, of shadow or ambient visibility, the larger; "
               "captured: both variances."},
    AspectRule{"visibility.denoised", "noise", ViewColors::deviation, 2, second_pair,
               "Standard deviation that the blur leaves, of shadow or ambient visibility, the "
               "larger; captured: both variances."},
    AspectRule{"visibility.history", "moved", ViewColors::heat, 2, second_pair,
               "How far rectification moved the remembered visibility: shadow, ambient."},
    AspectRule{"denoise.reprojection", "offset", ViewColors::difference, 2, offset,
               "From each pixel to where its surface was one frame ago, pixels.", "pixels"},
    AspectRule{"denoise.reprojection", "unseen", ViewColors::mark, 1, take<3>,
               "Surfaces that the frame before did not show: 1."},
    AspectRule{"specular.radiance", "distance", ViewColors::distance, 1, take<3>,
               "Distance from the surface to what it mirrors, metres; 10000: the environment.",
               "metres"},
    AspectRule{"specular.history", "moved", ViewColors::heat, 1, take<1>,
               "How far rectification moved the remembered reflection."},
    AspectRule{"specular.temporal", "noise", ViewColors::deviation, 1, take<3>,
               "Standard deviation of the reflection's brightness before the blur; captured: "
               "variance."},
    AspectRule{"specular.denoised", "noise", ViewColors::deviation, 1, take<3>,
               "Standard deviation of the reflection's brightness that the blur leaves; captured: "
               "variance."},
    AspectRule{"accumulated", "stops", ViewColors::stops, 1, stops,
               "Luminance as exposed, in stops from middle grey.", "EV"},
};

const AspectRule* find_aspect(std::string_view view) {
  const std::size_t dot = view.rfind('.');
  if (dot == std::string_view::npos) return nullptr;
  for (const AspectRule& rule : aspect_rules) {
    if (rule.name == view.substr(dot + 1) && matches(view.substr(0, dot), rule.buffer)) {
      return &rule;
    }
  }
  return nullptr;
}

}  // namespace

ViewColors colors_of(std::string_view view) {
  if (const AspectRule* aspect = find_aspect(view)) return aspect->colors;
  for (const BufferRule& rule : buffer_rules) {
    if (matches(view, rule.pattern)) return rule.colors;
  }
  return ViewColors::radiance;
}

std::string_view description_of(std::string_view view) {
  if (const AspectRule* aspect = find_aspect(view)) return aspect->description;
  for (const BufferRule& rule : buffer_rules) {
    if (matches(view, rule.pattern)) return rule.description;
  }
  return {};
}

std::vector<std::string> aspects_of(std::string_view buffer) {
  std::vector<std::string> aspects;
  for (const AspectRule& rule : aspect_rules) {
    if (!matches(buffer, rule.buffer)) continue;
    aspects.push_back(std::string(buffer) + "." + std::string(rule.name));
  }
  return aspects;
}

std::string_view source_of(std::string_view view) {
  return find_aspect(view) ? view.substr(0, view.rfind('.')) : std::string_view{};
}

std::string_view unit_of(std::string_view view) {
  if (const AspectRule* aspect = find_aspect(view)) return aspect->unit;
  for (const BufferRule& rule : buffer_rules) {
    if (matches(view, rule.pattern)) return rule.unit;
  }
  return {};
}

FloatImage extract(std::string_view view, const FloatImage& source, const ViewContext& context,
                   glm::uvec2 origin) {
  const AspectRule* rule = find_aspect(view);
  if (!rule) return source;
  FloatImage values{.width = source.width, .height = source.height, .channels = rule->channels};
  values.rgba.reserve(source.rgba.size());
  for (std::uint32_t y = 0; y < source.height; ++y) {
    for (std::uint32_t x = 0; x < source.width; ++x) {
      const float* texel = &source.rgba[(std::size_t{y} * source.width + x) * 4];
      const glm::vec2 position(x + origin.x + 0.5f, y + origin.y + 0.5f);
      const glm::vec4 value =
          rule->extract({{texel[0], texel[1], texel[2], texel[3]}, position}, context);
      values.rgba.insert(values.rgba.end(), {value.x, value.y, value.z, value.w});
    }
  }
  return values;
}

}  // namespace heliograph::render
