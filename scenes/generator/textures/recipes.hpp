#pragma once

#include <cstdint>
#include <string>

#include "scenes/generator/textures/texture.hpp"

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

// floors and objects of the smaller scenes; `width` is one repeat
TextureRecipe checker(const std::string& name, glm::vec3 light, glm::vec3 dark, int squares,
                      float width);
TextureRecipe metal_panels(const std::string& name, glm::vec3 metal, float roughness, float width);
TextureRecipe lattice();
TextureRecipe concrete_slabs(const std::string& name, glm::vec3 color, float width);
TextureRecipe terrazzo(const std::string& name, glm::vec3 ground, std::uint32_t seed);
TextureRecipe glazed(const std::string& name, glm::vec3 color, std::uint32_t seed);
TextureRecipe brushed_metal(const std::string& name, glm::vec3 metal, float roughness,
                            std::uint32_t seed);
TextureRecipe linen(const std::string& name, glm::vec3 cloth, glm::vec3 stripe);

/// 0 hills at sunset, 1 a dish of lemons, 2 fields of colour; fills the whole tile.
TextureRecipe painting(int subject);

}  // namespace heliograph::scenes::recipes
