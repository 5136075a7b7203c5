#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "scene/image/image_size.hpp"

namespace heliograph::scene {

/// The factors of KHR_materials_pbrSpecularGlossiness; colours are linear.
struct SpecularGlossiness {
  glm::vec4 diffuse{1.0f};
  glm::vec3 specular{1.0f};
  float glossiness = 1.0f;
  bool operator==(const SpecularGlossiness&) const = default;
};

struct MetallicRoughness {
  glm::vec4 base_color{1.0f};
  float metallic = 1.0f;
  float roughness = 1.0f;
};

/// The metallic-roughness material that looks most like a point of the other model: the metallic
/// share is solved for from the brightness of both colours, with a dielectric reflectance of 4 %
/// (as in Khronos' conversion of the extension).
MetallicRoughness to_metallic_roughness(const SpecularGlossiness& from);

enum class ConvertedImage { base_color, metallic_roughness };

/// RGBA8 texels of an image of either model; empty: white.
struct SourceTexels {
  ImageSize size;
  std::span<const std::uint8_t> rgba;
};

/// Converts the texels of both images, times the factors, to one image of the metallic-roughness
/// model, of `size`. The colours of both are sRGB, as are those of the base colour.
void convert_texels(ConvertedImage kind, const SpecularGlossiness& factors,
                    const SourceTexels& diffuse, const SourceTexels& specular, ImageSize size,
                    std::span<std::uint8_t> rgba);

}  // namespace heliograph::scene
