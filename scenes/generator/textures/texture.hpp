#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <string>

#include "scenes/generator/textures/image.hpp"

namespace heliograph::scenes {

/// Surface properties of a material at one point of its tile.
struct SurfaceSample {
  glm::vec3 color{0.5f};  // sRGB, 0..1, as it goes into the base colour map
  float height = 0.0f;    // metres above the mean surface
  float roughness = 0.8f;
  float metallic = 0.0f;
  float alpha = 1.0f;
};

/// A tile of surface: a function of (u, v) in [0,1]^2 (v down, as in the image) that repeats with
/// period 1 in both. `width` metres of surface are one repeat.
struct TextureRecipe {
  std::string name;
  float width = 1.0f;
  int resolution_divisor = 1;  // 2 halves the size asked for: for materials without fine detail
  bool masked = false;
  std::function<SurfaceSample(glm::vec2 uv)> sample;
};

/// The maps of a glTF metallic-roughness material. `surface` is occlusion in red, roughness in
/// green, metallic in blue. The normal map has +Y up, towards the top of the image.
struct TextureSet {
  Image color;
  Image normal;
  Image surface;
};

TextureSet bake(const TextureRecipe& recipe, int size);

}  // namespace heliograph::scenes
