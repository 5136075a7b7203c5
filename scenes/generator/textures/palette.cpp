#include "scenes/generator/textures/palette.hpp"

namespace heliograph::scenes {

int Palette::add(const std::string& name, TextureRecipe recipe, bool swept) {
  Material material;
  material.name = name;
  material.masked = recipe.masked;
  material.double_sided = recipe.masked;
  material.texture = std::move(recipe);
  material.swept = swept;
  return document_.add_material(std::move(material));
}

int Palette::add_cloth(const std::string& name, TextureRecipe recipe, bool swept) {
  const int index = add(name, std::move(recipe), swept);
  document_.materials[std::size_t(index)].double_sided = true;
  return index;
}

int Palette::add_plain(const std::string& name, glm::vec3 color, float roughness, float metallic,
                       bool swept) {
  Material material;
  material.name = name;
  material.color = color;
  material.roughness = roughness;
  material.metallic = metallic;
  material.swept = swept;
  return document_.add_material(std::move(material));
}

int Palette::add_glowing(const std::string& name, glm::vec3 color, glm::vec3 emission) {
  const int index = add_plain(name, color, 0.4f, 0.0f);
  document_.materials[std::size_t(index)].emission = emission;
  return index;
}

}  // namespace heliograph::scenes
