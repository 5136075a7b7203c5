#pragma once

#include "scenes/generator/atrium/atrium_materials.hpp"
#include "scenes/generator/gltf/document.hpp"

/// The parts of the atrium; each adds its meshes and places them.
namespace heliograph::scenes {

void add_floors(Document& document, const AtriumMaterials& materials);
void add_pool(Document& document, const AtriumMaterials& materials);
void add_columns(Document& document, const AtriumMaterials& materials);
void add_arcades(Document& document, const AtriumMaterials& materials);
void add_cornices(Document& document, const AtriumMaterials& materials);
void add_balustrades(Document& document, const AtriumMaterials& materials);
void add_vaults(Document& document, const AtriumMaterials& materials);
void add_aisle_walls(Document& document, const AtriumMaterials& materials);
void add_outer_walls(Document& document, const AtriumMaterials& materials);
void add_gallery(Document& document, const AtriumMaterials& materials);
void add_roof(Document& document, const AtriumMaterials& materials);
void add_lanterns(Document& document, const AtriumMaterials& materials);
void add_cloths(Document& document, const AtriumMaterials& materials);
void add_plants(Document& document, const AtriumMaterials& materials);

/// The clips `moving_camera` and `moving_objects_light`, loops of ten seconds. Finds what moves by
/// the names of the nodes; `case_number` as in make_atrium().
void add_clips(Document& document, int case_number);

}  // namespace heliograph::scenes
