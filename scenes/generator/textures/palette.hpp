#pragma once

#include <string>

#include "scenes/generator/gltf/document.hpp"

namespace heliograph::scenes {

/// Adds materials to a document.
class Palette {
 public:
  explicit Palette(Document& document) : document_(document) {}

  int add(const std::string& name, TextureRecipe recipe, bool swept = false);
  /// Seen from both sides.
  int add_cloth(const std::string& name, TextureRecipe recipe, bool swept = false);
  /// Without maps. `color` is linear.
  int add_plain(const std::string& name, glm::vec3 color, float roughness, float metallic,
                bool swept = false);
  int add_glowing(const std::string& name, glm::vec3 color, glm::vec3 emission);

 private:
  Document& document_;
};

}  // namespace heliograph::scenes
