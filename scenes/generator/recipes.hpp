#pragma once

#include <cstdint>
#include <string>

#include "scenes/generator/texture.hpp"

/// Procedural surfaces. All tile; sizes are in metres; colours are sRGB as a painter mixes them.
namespace heliograph::scenes::recipes {

struct MarbleLook {
  std::string name;
  glm::vec3 ground;
  glm::vec3 cloud;
  glm::vec3 vein;
  float vein_amount = 0.6f;
  float roughness = 0.25f;
  std::uint32_t seed = 1;
};

// stone
TextureRecipe marble(const MarbleLook& look, float width);
TextureRecipe ashlar(const std::string& name, glm::vec3 color, std::uint32_t seed);
TextureRecipe smooth_limestone(const std::string& name, glm::vec3 color, std::uint32_t seed);
TextureRecipe plaster(const std::string& name, glm::vec3 color, std::uint32_t seed);
TextureRecipe brick();
TextureRecipe terracotta(const std::string& name, glm::vec3 color, std::uint32_t seed);

// ornament
TextureRecipe star_vault();
TextureRecipe meander_frieze();
TextureRecipe mosaic();
TextureRecipe majolica();
TextureRecipe painted_panel();
TextureRecipe stencilled_fresco();

// wood, metal, cloth, plants
TextureRecipe wood(const std::string& name, glm::vec3 light, glm::vec3 dark, std::uint32_t seed);
TextureRecipe patinated_metal(const std::string& name, glm::vec3 metal, glm::vec3 patina,
                              float patina_amount, float roughness, std::uint32_t seed);
TextureRecipe gold();
TextureRecipe damask(const std::string& name, glm::vec3 cloth, glm::vec3 motif);
TextureRecipe leaf();
TextureRecipe soil();
TextureRecipe water();

}  // namespace heliograph::scenes::recipes
