#include "scene/gltf/materials/specular_glossiness.hpp"

#include <algorithm>
#include <cmath>

namespace heliograph::scene {
namespace {

constexpr float dielectric = 0.04f;
constexpr float tiny = 1e-6f;

float brightness(const glm::vec3& color) {
  return std::sqrt(glm::dot(color * color, glm::vec3(0.299f, 0.587f, 0.114f)));
}

/// The root in 0..1 of dielectric m^2 + (diffuse + specular - 2 dielectric) m + dielectric -
/// specular: what a metallic share m makes of both brightnesses.
float solve_metallic(float diffuse, float specular, float least_of_specular) {
  if (specular < dielectric) return 0.0f;
  const float b = diffuse * least_of_specular / (1.0f - dielectric) + specular - 2.0f * dielectric;
  const float c = dielectric - specular;
  const float root = std::sqrt(std::max(b * b - 4.0f * dielectric * c, 0.0f));
  return std::clamp((root - b) / (2.0f * dielectric), 0.0f, 1.0f);
}

const std::array<float, 256>& linear_of_srgb() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> values{};
    for (std::size_t i = 0; i < values.size(); ++i) {
      const float encoded = static_cast<float>(i) / 255.0f;
      values[i] =
          encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
    }
    return values;
  }();
  return table;
}

std::uint8_t to_byte(float value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0f, 1.0f) * 255.0f));
}

std::uint8_t to_srgb(float linear) {
  return to_byte(linear <= 0.0031308f ? linear * 12.92f
                                      : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f);
}

/// The texel of another image of possibly another size at the same place.
glm::vec4 texel(const SourceTexels& source, ImageSize size, std::uint32_t x, std::uint32_t y) {
  if (source.rgba.empty()) return glm::vec4(1.0f);
  const std::size_t column = std::uint64_t(x) * source.size.width / size.width;
  const std::size_t row = std::uint64_t(y) * source.size.height / size.height;
  const auto* const bytes = source.rgba.data() + 4 * (row * source.size.width + column);
  const auto& linear = linear_of_srgb();
  return {linear[bytes[0]], linear[bytes[1]], linear[bytes[2]],
          static_cast<float>(bytes[3]) / 255.0f};
}

}  // namespace

MetallicRoughness to_metallic_roughness(const SpecularGlossiness& from) {
  const glm::vec3 diffuse(from.diffuse);
  const float largest = std::max({from.specular.x, from.specular.y, from.specular.z});
  const float rest = 1.0f - largest;
  MetallicRoughness to;
  to.metallic = solve_metallic(brightness(diffuse), brightness(from.specular), rest);
  to.roughness = 1.0f - from.glossiness;
  const glm::vec3 of_diffuse =
      diffuse * (rest / (1.0f - dielectric) / std::max(1.0f - to.metallic, tiny));
  const glm::vec3 of_specular =
      (from.specular - glm::vec3(dielectric * (1.0f - to.metallic))) / std::max(to.metallic, tiny);
  const glm::vec3 color = glm::mix(of_diffuse, of_specular, to.metallic * to.metallic);
  to.base_color = glm::vec4(glm::clamp(color, 0.0f, 1.0f), from.diffuse.w);
  return to;
}

void convert_texels(ConvertedImage kind, const SpecularGlossiness& factors,
                    const SourceTexels& diffuse, const SourceTexels& specular, ImageSize size,
                    std::span<std::uint8_t> rgba) {
  std::size_t target = 0;
  for (std::uint32_t y = 0; y < size.height; ++y) {
    for (std::uint32_t x = 0; x < size.width; ++x, target += 4) {
      const glm::vec4 specular_texel = texel(specular, size, x, y);
      const MetallicRoughness to =
          to_metallic_roughness({.diffuse = factors.diffuse * texel(diffuse, size, x, y),
                                 .specular = factors.specular * glm::vec3(specular_texel),
                                 .glossiness = factors.glossiness * specular_texel.w});
      const glm::vec4& color = to.base_color;
      const std::array<std::uint8_t, 4> bytes =
          kind == ConvertedImage::base_color
              ? std::array<std::uint8_t, 4>{to_srgb(color.x), to_srgb(color.y), to_srgb(color.z),
                                            to_byte(color.w)}
              : std::array<std::uint8_t, 4>{255, to_byte(to.roughness), to_byte(to.metallic), 255};
      std::copy(bytes.begin(), bytes.end(), rgba.begin() + std::ptrdiff_t(target));
    }
  }
}

}  // namespace heliograph::scene
