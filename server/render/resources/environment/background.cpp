#include "render/resources/environment/background.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "render/resources/environment/environment_prefilter.hpp"
#include "scene/environment_sun.hpp"

namespace heliograph::render {
namespace {

using protocol::BackgroundKind;

// Texels of 3.75 degrees: the narrowest blur is as wide.
constexpr std::uint32_t blurred_width = 96, blurred_height = 48;
constexpr float narrowest = 4.0f, widest = 50.0f;  // degrees

constexpr std::uint32_t gradient_height = 256;
constexpr float gradient_from = -10.0f, gradient_to = 40.0f;  // elevation, degrees

glm::vec3 radiance_of(protocol::Color color) {
  const std::array<float, 3> channels = protocol::linear(color);
  return {channels[0], channels[1], channels[2]};
}

float polar_angle(std::uint32_t row, std::uint32_t rows) {
  return (static_cast<float>(row) + 0.5f) / static_cast<float>(rows) * std::numbers::pi_v<float>;
}

/// Means over the texels that fall into each of fewer ones; the nearest texel of a smaller map.
scene::Environment reduced(const scene::Environment& map) {
  scene::Environment small{blurred_width, blurred_height, {}};
  small.radiance.reserve(std::size_t{blurred_width} * blurred_height);
  const auto first = [](std::uint32_t index, std::uint32_t of, std::uint32_t texels) {
    return static_cast<std::uint32_t>(std::uint64_t{index} * texels / of);
  };
  for (std::uint32_t y = 0; y < blurred_height; ++y) {
    const std::uint32_t top = first(y, blurred_height, map.height);
    const std::uint32_t bottom = std::max(first(y + 1, blurred_height, map.height), top + 1);
    for (std::uint32_t x = 0; x < blurred_width; ++x) {
      const std::uint32_t left = first(x, blurred_width, map.width);
      const std::uint32_t right = std::max(first(x + 1, blurred_width, map.width), left + 1);
      glm::vec3 sum(0.0f);
      for (std::uint32_t row = top; row < bottom; ++row) {
        const glm::vec3* const line = &map.radiance[std::size_t{row} * map.width];
        for (std::uint32_t column = left; column < right; ++column) sum += line[column];
      }
      small.radiance.push_back(sum / static_cast<float>((bottom - top) * (right - left)));
    }
  }
  return small;
}

/// The weights of a row's texels in one of another row, by the difference of their columns: a von
/// Mises-Fisher lobe, which is a Gaussian on the sphere, times the solid angle of a texel.
std::array<float, blurred_width> lobe_weights(std::uint32_t row, std::uint32_t other,
                                              float deviation) {
  const float here = polar_angle(row, blurred_height), there = polar_angle(other, blurred_height);
  std::array<float, blurred_width> weights{};
  for (std::uint32_t columns = 0; columns < blurred_width; ++columns) {
    const float around =
        2.0f * std::numbers::pi_v<float> * static_cast<float>(columns) / blurred_width;
    const float cosine =
        std::cos(here) * std::cos(there) + std::sin(here) * std::sin(there) * std::cos(around);
    weights[columns] = std::exp((cosine - 1.0f) / (deviation * deviation)) * std::sin(there);
  }
  return weights;
}

scene::Environment blurred(const scene::Environment& map, float deviation) {
  const scene::Environment small = reduced(map);
  scene::Environment result{blurred_width, blurred_height,
                            std::vector<glm::vec3>(small.radiance.size(), glm::vec3(0.0f))};
  for (std::uint32_t row = 0; row < blurred_height; ++row) {
    glm::vec3* const to = &result.radiance[std::size_t{row} * blurred_width];
    float total = 0.0f;
    for (std::uint32_t other = 0; other < blurred_height; ++other) {
      const auto weights = lobe_weights(row, other, deviation);
      const glm::vec3* const from = &small.radiance[std::size_t{other} * blurred_width];
      for (std::uint32_t columns = 0; columns < blurred_width; ++columns) {
        total += weights[columns];
        for (std::uint32_t x = 0; x < blurred_width; ++x) {
          to[x] += weights[columns] * from[(x + columns) % blurred_width];
        }
      }
    }
    for (std::uint32_t x = 0; x < blurred_width; ++x) to[x] /= total;
  }
  return result;
}

/// Interpolated between square roots, which looks even.
scene::Environment gradient(const glm::vec3& lower, const glm::vec3& upper) {
  scene::Environment map{1, gradient_height, {}};
  for (std::uint32_t row = 0; row < gradient_height; ++row) {
    const float elevation = 90.0f - glm::degrees(polar_angle(row, gradient_height));
    const float share = glm::smoothstep(gradient_from, gradient_to, elevation);
    const glm::vec3 root = glm::mix(glm::sqrt(lower), glm::sqrt(upper), share);
    map.radiance.push_back(root * root);
  }
  return map;
}

}  // namespace

scene::Environment background_map(const scene::Environment& environment,
                                  const protocol::Settings::Background& chosen) {
  switch (chosen.show) {
    case BackgroundKind::environment:
      return environment;
    case BackgroundKind::blurred:
      return blurred(scene::separate_sun(environment).sky,
                     glm::radians(glm::mix(narrowest, widest, chosen.blur)));
    case BackgroundKind::gradient:
      return gradient(radiance_of(chosen.color), radiance_of(chosen.upper_color));
    case BackgroundKind::color:
      return {1, 1, {radiance_of(chosen.color)}};
  }
  return environment;
}

Background::Background(const gpu::Device& device, scene::Environment made)
    : map(std::move(made)), image(upload_environment(device, map)) {}

}  // namespace heliograph::render
