#include "scenes/generator/atrium/atrium_materials.hpp"

#include "scenes/generator/textures/palette.hpp"
#include "scenes/generator/textures/recipes.hpp"

namespace heliograph::scenes {
namespace {

using namespace recipes;

}  // namespace

AtriumMaterials add_atrium_materials(Document& document, Gloss gloss) {
  const bool columns = gloss != Gloss::floor;
  const bool all = gloss == Gloss::nearly_all;
  const glm::vec3 ivory(0.86f, 0.80f, 0.70f);
  Palette palette(document);
  AtriumMaterials m{};

  m.floor_light = palette.add("floor_light",
                              marble({"floor_light",
                                      {0.84f, 0.815f, 0.77f},
                                      {0.77f, 0.735f, 0.675f},
                                      {0.54f, 0.49f, 0.43f},
                                      0.55f,
                                      0.16f,
                                      1},
                                     1.9f),
                              true);
  m.floor_dark = palette.add("floor_dark",
                             marble({"floor_dark",
                                     {0.12f, 0.17f, 0.15f},
                                     {0.17f, 0.25f, 0.21f},
                                     {0.56f, 0.64f, 0.57f},
                                     0.7f,
                                     0.12f,
                                     2},
                                    1.3f),
                             true);
  m.floor_red = palette.add("floor_red",
                            marble({"floor_red",
                                    {0.55f, 0.235f, 0.18f},
                                    {0.64f, 0.33f, 0.25f},
                                    {0.86f, 0.74f, 0.66f},
                                    0.65f,
                                    0.15f,
                                    3},
                                   1.5f),
                            true);
  m.mortar = palette.add_plain("mortar", {0.16f, 0.14f, 0.12f}, 0.95f, 0.0f);

  m.ashlar = palette.add("ashlar", ashlar("ashlar", {0.83f, 0.76f, 0.65f}, 11), all);
  m.trim = palette.add("trim", smooth_limestone("trim", ivory, 12), columns);
  m.trim_red =
      palette.add("trim_red", smooth_limestone("trim_red", {0.74f, 0.52f, 0.43f}, 13), columns);
  m.column = palette.add("column",
                         marble({"column",
                                 {0.90f, 0.86f, 0.79f},
                                 {0.84f, 0.77f, 0.68f},
                                 {0.64f, 0.52f, 0.42f},
                                 0.45f,
                                 0.34f,
                                 4},
                                1.2f),
                         columns);
  m.column_dark = palette.add("column_dark",
                              marble({"column_dark",
                                      {0.48f, 0.17f, 0.14f},
                                      {0.36f, 0.13f, 0.12f},
                                      {0.83f, 0.68f, 0.60f},
                                      0.55f,
                                      0.18f,
                                      5},
                                     0.9f),
                              columns);
  m.capital =
      palette.add("capital", smooth_limestone("capital", {0.89f, 0.84f, 0.75f}, 14), columns);

  m.plaster = palette.add("plaster", plaster("plaster", {0.92f, 0.85f, 0.71f}, 21), all);
  m.plaster_upper =
      palette.add("plaster_upper", plaster("plaster_upper", {0.88f, 0.73f, 0.57f}, 22), all);
  m.brick = palette.add("brick", recipes::brick(), all);
  m.fresco = palette.add("fresco", stencilled_fresco(), all);

  m.star_vault = palette.add("star_vault", recipes::star_vault());
  m.frieze = palette.add("frieze", meander_frieze(), all);
  m.mosaic = palette.add("mosaic", recipes::mosaic());
  m.painted_panel = palette.add("painted_panel", recipes::painted_panel(), all);

  m.beam = palette.add("beam", wood("beam", {0.42f, 0.28f, 0.18f}, {0.24f, 0.15f, 0.10f}, 31), all);
  m.door = palette.add("door", wood("door", {0.36f, 0.21f, 0.13f}, {0.20f, 0.11f, 0.07f}, 32), all);

  m.bronze = palette.add(
      "bronze",
      patinated_metal("bronze", {0.78f, 0.60f, 0.40f}, {0.36f, 0.50f, 0.42f}, 0.5f, 0.32f, 41),
      columns);
  m.iron = palette.add(
      "iron",
      patinated_metal("iron", {0.52f, 0.50f, 0.48f}, {0.30f, 0.20f, 0.14f}, 0.7f, 0.45f, 42), all);
  m.gold = palette.add("gold", recipes::gold(), columns);
  m.mirror = palette.add_plain("mirror", {0.95f, 0.95f, 0.94f}, 0.02f, 1.0f);

  m.roof = palette.add("roof", terracotta("roof", {0.70f, 0.41f, 0.28f}, 51));
  m.pot = palette.add("pot", terracotta("pot", {0.72f, 0.44f, 0.31f}, 52), columns);
  m.majolica = palette.add("majolica", recipes::majolica(), columns);

  m.banners = {
      palette.add_cloth("banner_red",
                        damask("banner_red", {0.70f, 0.08f, 0.07f}, {0.84f, 0.60f, 0.25f}), all),
      palette.add_cloth("banner_green",
                        damask("banner_green", {0.11f, 0.38f, 0.20f}, {0.78f, 0.66f, 0.34f}), all),
      palette.add_cloth("banner_blue",
                        damask("banner_blue", {0.10f, 0.20f, 0.54f}, {0.80f, 0.68f, 0.40f}), all)};
  m.curtain = palette.add_cloth(
      "curtain", damask("curtain", {0.50f, 0.07f, 0.08f}, {0.64f, 0.19f, 0.13f}), all);

  m.leaf = palette.add("leaf", recipes::leaf());
  m.soil = palette.add("soil", recipes::soil());
  m.water = palette.add("water", recipes::water());
  m.lantern_glass =
      palette.add_glowing("lantern_glass", {0.9f, 0.75f, 0.5f}, glm::vec3(6.0f, 3.6f, 1.5f));
  return m;
}

}  // namespace heliograph::scenes
