#include "render/debug_view.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <glm/glm.hpp>
#include <glm/gtc/packing.hpp>

namespace heliograph::render {
namespace {

float channel(const std::byte* texel, VkFormat format, std::uint32_t index) {
  const auto load = [&]<typename T>(T, std::uint32_t count, float scale) {
    if (index >= count) return index == 3 ? 1.0f : 0.0f;
    T value;
    std::memcpy(&value, texel + index * sizeof(T), sizeof(T));
    return static_cast<float>(value) * scale;
  };
  switch (format) {
    case VK_FORMAT_R32G32B32A32_SFLOAT:
      return load(0.0f, 4, 1.0f);
    case VK_FORMAT_R32G32_SFLOAT:
      return load(0.0f, 2, 1.0f);
    case VK_FORMAT_R32_SFLOAT:
      return load(0.0f, 1, 1.0f);
    case VK_FORMAT_R32_UINT:
      return load(std::uint32_t{}, 1, 1.0f);
    case VK_FORMAT_R8G8B8A8_UNORM:
      return load(std::uint8_t{}, 4, 1.0f / 255.0f);
    case VK_FORMAT_R16G16B16A16_SFLOAT: {
      std::uint16_t half;
      std::memcpy(&half, texel + index * 2, 2);
      return glm::unpackHalf1x16(half);
    }
    default:
      throw gpu::GpuError(std::string("no view of ") + gpu::format_name(format));
  }
}

/// sRGB encoding of a linear value (IEC 61966-2-1).
float encode(float linear) {
  const float c = std::clamp(linear, 0.0f, 1.0f);
  return c <= 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1.0f / 2.4f) - 0.055f;
}

glm::vec3 octahedral_decode(const glm::vec2& p) {
  glm::vec3 d{p, 1.0f - std::abs(p.x) - std::abs(p.y)};
  const float below = std::max(-d.z, 0.0f);
  d.x += d.x >= 0.0f ? -below : below;
  d.y += d.y >= 0.0f ? -below : below;
  return glm::normalize(d);
}

/// A colour for an id that differs from its neighbours': golden-ratio steps around the hue circle.
glm::vec3 id_color(float id) {
  if (id == 0.0f) return glm::vec3(0.0f);
  const float hue = static_cast<float>(std::fmod(static_cast<double>(id) * 0.618033988749895, 1.0));
  const auto wave = [&](float shift) {
    return 0.55f + 0.45f * std::cos(6.2831853f * (hue + shift));
  };
  return {wave(0.0f), wave(1.0f / 3.0f), wave(2.0f / 3.0f)};
}

/// Largest |value| that the view must show, from a percentile so that one outlier cannot dim it.
float scale_of(const FloatImage& image, const std::function<float(const float*)>& measure) {
  std::vector<float> values;
  const std::size_t count = std::size_t{image.width} * image.height;
  values.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const float value = measure(&image.rgba[i * 4]);
    if (std::isfinite(value) && value > 0.0f) values.push_back(value);
  }
  if (values.empty()) return 1.0f;
  const auto at = values.begin() + static_cast<long>((values.size() - 1) * 0.98);
  std::nth_element(values.begin(), at, values.end());
  return std::max(*at, 1e-9f);
}

using Colorize = std::function<glm::vec3(const float*)>;  // texel -> sRGB encoded, 0..1

Colorize colors_for(std::string_view buffer, const FloatImage& image) {
  const auto ends_with = [&](std::string_view suffix) { return buffer.ends_with(suffix); };
  if (buffer == "output") return [](const float* v) { return glm::vec3(v[0], v[1], v[2]); };
  if (ends_with("normals")) {
    return [](const float* v) {
      if (v[0] == 0.0f && v[1] == 0.0f && v[2] == 0.0f && v[3] == 0.0f) return glm::vec3(0.0f);
      return octahedral_decode({v[0], v[1]}) * 0.5f + 0.5f;
    };
  }
  if (ends_with("base_color")) {
    return [](const float* v) {
      return glm::vec3(encode(v[0] * v[0]), encode(v[1] * v[1]), encode(v[2] * v[2]));
    };
  }
  if (ends_with("motion")) {
    // Motion in red and green about grey, view Z in blue: nearer is brighter.
    const float speed = scale_of(image, [](const float* v) { return std::hypot(v[0], v[1]); });
    return [speed](const float* v) {
      const float depth = v[3] > 0.0f ? 1.0f / (1.0f + 0.1f * v[3]) : 0.0f;
      return glm::vec3(0.5f + 0.5f * v[0] / speed, 0.5f + 0.5f * v[1] / speed, depth);
    };
  }
  if (ends_with("depth_slope")) {
    const float slope = scale_of(image, [](const float* v) { return std::hypot(v[0], v[1]); });
    return [slope](const float* v) {
      return glm::vec3(0.5f + 0.5f * v[0] / slope, 0.5f + 0.5f * v[1] / slope, 0.5f);
    };
  }
  if (ends_with("instance")) return [](const float* v) { return id_color(v[0]); };
  if (ends_with("visibility")) return [](const float* v) { return glm::vec3(v[0]); };
  if (ends_with("surface")) return [](const float* v) { return glm::vec3(v[0], v[1], v[2]); };
  // Radiance: Reinhard's curve keeps every value visible.
  return [](const float* v) {
    return glm::vec3(encode(v[0] / (1.0f + v[0])), encode(v[1] / (1.0f + v[1])),
                     encode(v[2] / (1.0f + v[2])));
  };
}

}  // namespace

FloatImage read_image(const gpu::Image& image) {
  const auto& desc = image.desc();
  const std::vector<std::byte> bytes = image.download();
  const std::uint32_t stride = gpu::texel_bytes(desc.format);
  FloatImage values{desc.extent.width, desc.extent.height, {}};
  const std::size_t count = std::size_t{values.width} * values.height;
  values.rgba.resize(count * 4);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::uint32_t c = 0; c < 4; ++c) {
      values.rgba[i * 4 + c] = channel(bytes.data() + i * stride, desc.format, c);
    }
  }
  return values;
}

Frame visualise(std::string_view buffer, const FloatImage& values) {
  const Colorize color = colors_for(buffer, values);
  Frame frame;
  frame.width = values.width;
  frame.height = values.height;
  frame.rgba.resize(values.rgba.size());
  for (std::size_t i = 0; i < values.rgba.size(); i += 4) {
    const glm::vec3 c = color(&values.rgba[i]);
    for (int k = 0; k < 3; ++k) {
      // A comparison that NaN fails: bad pixels stand out in black.
      const float v = c[k] > 0.0f ? std::min(c[k], 1.0f) : 0.0f;
      frame.rgba[i + k] = static_cast<std::uint8_t>(v * 255.0f + 0.5f);
    }
    frame.rgba[i + 3] = 255;
  }
  return frame;
}

}  // namespace heliograph::render
