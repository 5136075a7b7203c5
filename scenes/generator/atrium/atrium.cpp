#include "scenes/generator/atrium/atrium.hpp"

#include <stdexcept>
#include <string>

#include "scenes/generator/atrium/atrium_parts.hpp"
#include "scenes/generator/sky/sunlight.hpp"

namespace heliograph::scenes {
namespace {

struct View {
  const char* name;
  glm::vec3 eye;
  glm::vec3 target;
  float vertical_fov;  // degrees
};

constexpr View along_nave{"along_nave", {13.6f, 1.75f, 1.5f}, {-4.0f, 3.3f, -0.9f}, 56.0f};
constexpr View gallery{"gallery", {15.6f, 8.5f, 0.5f}, {-2.0f, 4.3f, -1.3f}, 58.0f};
constexpr View courtyard{"courtyard", {-7.4f, 2.0f, 3.9f}, {2.0f, 2.6f, -3.2f}, 56.0f};
constexpr View floor_view{"floor", {9.0f, 0.45f, -1.0f}, {0.0f, 0.9f, 0.4f}, 50.0f};

void add_cameras(Document& document, int case_number) {
  View main = case_number == 1 ? along_nave : case_number == 2 ? gallery : courtyard;
  main.name = "main";
  const View along = {"nave", along_nave.eye, along_nave.target, along_nave.vertical_fov};
  for (const View& view : {main, along, gallery, courtyard, floor_view}) {
    document.add_camera(view.name, view.eye, view.target, view.vertical_fov);
  }
}

}  // namespace

Document make_atrium(int case_number, const ClearSky& sky) {
  if (case_number < 1 || case_number > 3) {
    throw std::invalid_argument("atrium case must be 1, 2 or 3");
  }
  constexpr Gloss gloss[] = {Gloss::floor, Gloss::floor_columns_trim, Gloss::nearly_all};
  Document document;
  document.name = "glossy_sponza_" + std::to_string(case_number);
  document.description = "An atrium of two storeys round a courtyard open to the sky";
  const AtriumMaterials materials = add_atrium_materials(document, gloss[case_number - 1]);
  add_cameras(document, case_number);
  add_sun(document, {sun_elevation, sun_azimuth}, sky);
  add_floors(document, materials);
  add_pool(document, materials);
  add_columns(document, materials);
  add_arcades(document, materials);
  add_cornices(document, materials);
  add_balustrades(document, materials);
  add_vaults(document, materials);
  add_aisle_walls(document, materials);
  add_outer_walls(document, materials);
  add_gallery(document, materials);
  add_roof(document, materials);
  add_lanterns(document, materials);
  add_cloths(document, materials);
  add_plants(document, materials);
  add_clips(document, case_number);
  return document;
}

}  // namespace heliograph::scenes
