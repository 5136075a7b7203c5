#pragma once

#include <array>

#include "scenes/generator/gltf/document.hpp"

namespace heliograph::scenes {

/// Which materials take the swept roughness: the three cases of the paper's Glossy Sponza.
enum class Gloss { floor, floor_columns_trim, nearly_all };

/// Indices into Document::materials.
struct AtriumMaterials {
  int floor_light, floor_dark, floor_red, mortar;
  int ashlar, trim, trim_red, column, column_dark, capital;
  int plaster, plaster_upper, fresco, brick;
  int star_vault, frieze, mosaic, painted_panel;
  int beam, door;
  int bronze, iron, gold, mirror;
  int roof, pot, majolica;
  std::array<int, 3> banners;
  int curtain;
  int leaf, soil, water, lantern_glass;
};

AtriumMaterials add_atrium_materials(Document& document, Gloss gloss);

}  // namespace heliograph::scenes
