#include "render/views/view_colors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <utility>

#include "render/api/octahedral.hpp"

namespace heliograph::render {
namespace {

using Texel = const float*;
using Colorize = std::function<glm::vec3(Texel)>;  // -> sRGB encoded, 0..1

/// sRGB encoding of a linear value (IEC 61966-2-1).
float encode(float linear) {
  const float c = std::clamp(linear, 0.0f, 1.0f);
  return c <= 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1.0f / 2.4f) - 0.055f;
}

glm::vec3 encode(const glm::vec3& linear) {
  return {encode(linear.x), encode(linear.y), encode(linear.z)};
}

/// Dark blue over green to yellow in even steps of perceived brightness: nine colours of viridis
/// (van der Walt and Smith 2015) and what lies between them.
glm::vec3 heat(float value) {
  static constexpr std::array<std::array<float, 3>, 9> colors{{{0.267f, 0.005f, 0.329f},
                                                               {0.278f, 0.176f, 0.483f},
                                                               {0.231f, 0.322f, 0.545f},
                                                               {0.173f, 0.447f, 0.557f},
                                                               {0.129f, 0.569f, 0.549f},
                                                               {0.157f, 0.682f, 0.502f},
                                                               {0.369f, 0.788f, 0.384f},
                                                               {0.678f, 0.863f, 0.188f},
                                                               {0.993f, 0.906f, 0.144f}}};
  if (std::isnan(value)) return glm::vec3(0.0f);
  const float position = std::clamp(value, 0.0f, 1.0f) * (colors.size() - 1);
  const std::size_t below = std::min(static_cast<std::size_t>(position), colors.size() - 2);
  const auto color = [](const std::array<float, 3>& c) { return glm::vec3(c[0], c[1], c[2]); };
  return glm::mix(color(colors[below]), color(colors[below + 1]),
                  position - static_cast<float>(below));
}

glm::vec3 direction_color(const glm::vec3& direction) {
  const float size = glm::length(direction);
  return size > 0.0f ? direction / size * 0.5f + 0.5f : glm::vec3(0.0f);
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

/// The 2nd and the 98th percentile of what `measure` finds positive; 1 and 1 where nothing is.
std::pair<float, float> range_of(const FloatImage& image,
                                 const std::function<float(Texel)>& measure) {
  std::vector<float> values;
  const std::size_t count = std::size_t{image.width} * image.height;
  values.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const float value = measure(&image.rgba[i * 4]);
    if (std::isfinite(value) && value > 0.0f) values.push_back(value);
  }
  if (values.empty()) return {1.0f, 1.0f};
  const auto percentile = [&](double fraction) {
    const auto at = values.begin() + static_cast<long>((values.size() - 1) * fraction);
    std::nth_element(values.begin(), at, values.end());
    return std::max(*at, 1e-9f);
  };
  const float low = percentile(0.02);
  return {low, percentile(0.98)};
}

Colorize relative_heat(const FloatImage& image, std::function<float(Texel)> measure,
                       float at_least = 0.0f) {
  const float largest = std::max(range_of(image, measure).second, at_least);
  return [measure, largest](Texel v) { return heat(measure(v) / largest); };
}

Colorize difference_colors(const FloatImage& image) {
  const float largest = range_of(image, [](Texel v) { return std::hypot(v[0], v[1]); }).second;
  return [largest](Texel v) {
    return glm::vec3(0.5f + 0.5f * v[0] / largest, 0.5f + 0.5f * v[1] / largest, 0.5f);
  };
}

Colorize distance_colors(const FloatImage& image) {
  const auto [near, far] = range_of(image, [](Texel v) { return v[0] < 9e3f ? v[0] : 0.0f; });
  const float span = std::max(std::log2(far / near), 1e-3f);
  return [low = std::log2(near), span](Texel v) {
    return v[0] > 0.0f ? heat((std::log2(v[0]) - low) / span) : glm::vec3(0.0f);
  };
}

float deviation(Texel v) {
  return std::sqrt(std::max({v[0], v[1], 0.0f}));
}

Colorize colors_for(ViewColors colors, const FloatImage& image) {
  const auto x = [](Texel v) { return v[0]; };
  switch (colors) {
    case ViewColors::output:
    case ViewColors::channels:
      return [](Texel v) { return glm::vec3(v[0], v[1], v[2]); };
    case ViewColors::radiance:
      return [](Texel v) {
        return encode({v[0] / (1.0f + v[0]), v[1] / (1.0f + v[1]), v[2] / (1.0f + v[2])});
      };
    case ViewColors::squared:
      return [](Texel v) { return encode({v[0] * v[0], v[1] * v[1], v[2] * v[2]}); };
    case ViewColors::grey:
      return [](Texel v) { return glm::vec3(v[0]); };
    case ViewColors::direction:
      return [](Texel v) { return direction_color({v[0], v[1], v[2]}); };
    case ViewColors::octahedral:
      return [](Texel v) {
        const bool none = v[0] > 1.5f;  // see rasterize_gbuffer()
        return none ? glm::vec3(0.0f) : direction_color(octahedral_decode({v[0], v[1]}));
      };
    case ViewColors::difference:
      return difference_colors(image);
    case ViewColors::identity:
      return [](Texel v) { return id_color(v[0]); };
    case ViewColors::fraction:
      return [](Texel v) { return heat(v[0]); };
    case ViewColors::heat:
      return relative_heat(image, x);
    case ViewColors::deviation:
      return relative_heat(image, deviation);
    case ViewColors::distance:
      return distance_colors(image);
    case ViewColors::stops:
      return [](Texel v) { return heat((v[0] + 8.0f) / 16.0f); };
    case ViewColors::pixels:
      return relative_heat(image, x, 0.1f);
    case ViewColors::mark:
      break;
  }
  return [](Texel v) { return v[0] > 0.5f ? glm::vec3(0.9f, 0.2f, 0.15f) : glm::vec3(0.12f); };
}

}  // namespace

std::string_view legend(ViewColors colors) {
  switch (colors) {
    case ViewColors::output:
      return "";
    case ViewColors::radiance:
      return "Shown through Reinhard's curve.";
    case ViewColors::squared:
    case ViewColors::channels:
      return "Shown as red, green and blue.";
    case ViewColors::grey:
      return "Black 0, white 1.";
    case ViewColors::direction:
    case ViewColors::octahedral:
      return "Red, green and blue are x, y and z, grey being 0.";
    case ViewColors::difference:
      return "Red and green are right and down about grey, to the frame's own largest.";
    case ViewColors::identity:
      return "A colour for each, black where there is none.";
    case ViewColors::fraction:
      return "Dark blue 0, yellow 1.";
    case ViewColors::heat:
    case ViewColors::deviation:
      return "Dark blue 0, yellow the frame's own largest.";
    case ViewColors::distance:
      return "Dark blue near, yellow far, in equal steps of the logarithm over the frame's own "
             "range; black where there is none.";
    case ViewColors::stops:
      return "Dark blue 8 stops below middle grey, green middle grey, yellow 8 stops above.";
    case ViewColors::pixels:
      return "Dark blue 0, yellow the frame's own largest, but at least a tenth of a pixel.";
    case ViewColors::mark:
      break;
  }
  return "Red where it is so.";
}

Frame colorize(ViewColors colors, const FloatImage& values) {
  const Colorize color = colors_for(colors, values);
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
