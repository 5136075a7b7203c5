#include <cmath>

#include "scenes/generator/breakfast_room/breakfast_parts.hpp"
#include "scenes/generator/geometry/icosphere.hpp"
#include "scenes/generator/geometry/shapes.hpp"
#include "scenes/generator/scenes/paper_scenes.hpp"
#include "scenes/generator/textures/palette.hpp"
#include "scenes/generator/textures/recipes.hpp"

// A table laid for five in the sun that comes through mullioned windows and a blind.
namespace heliograph::scenes {
namespace {

constexpr glm::vec3 breakfast_target(1.0f, 0.95f, -0.7f);

Pose breakfast_camera_pose(float phase) {
  const glm::vec3 eye(-2.7f + 0.8f * std::sin(two_pi * phase), 1.65f,
                      3.2f - 0.5f * there_and_back(phase));
  return look(eye, breakfast_target);
}

void add_fabrics(Palette& palette, BreakfastMaterials& m) {
  using namespace recipes;
  m.cushion =
      palette.add("cushion", linen("cushion", {0.86f, 0.80f, 0.68f}, {0.20f, 0.34f, 0.52f}));
  m.rug = palette.add("rug", damask("rug", {0.46f, 0.12f, 0.10f}, {0.80f, 0.64f, 0.42f}));
  m.runner =
      palette.add_cloth("runner", linen("runner", {0.90f, 0.87f, 0.80f}, {0.70f, 0.20f, 0.14f}));
  m.shade =
      palette.add_cloth("shade", linen("shade", {0.93f, 0.86f, 0.70f}, {0.86f, 0.76f, 0.58f}));
}

BreakfastMaterials add_materials(Document& document) {
  using namespace recipes;
  Palette palette(document);
  BreakfastMaterials m{};
  m.floor =
      palette.add("floor", wood("floor", {0.66f, 0.45f, 0.27f}, {0.45f, 0.28f, 0.16f}, 3101), true);
  m.plaster = palette.add("wall", plaster("wall", {0.93f, 0.89f, 0.80f}, 3102));
  m.accent = palette.add("accent_wall", plaster("accent_wall", {0.56f, 0.66f, 0.60f}, 3103));
  m.ceiling = palette.add("ceiling", plaster("ceiling", {0.95f, 0.94f, 0.91f}, 3104));
  m.frame = palette.add("window_frame", glazed("window_frame", {0.92f, 0.91f, 0.88f}, 3105));
  m.slat = palette.add_plain("slat", {0.80f, 0.74f, 0.62f}, 0.5f, 0.0f);
  document.materials[std::size_t(m.slat)].double_sided = true;
  m.table =
      palette.add("table", wood("table", {0.50f, 0.31f, 0.18f}, {0.30f, 0.17f, 0.09f}, 3106), true);
  m.chair =
      palette.add("chair", wood("chair", {0.44f, 0.27f, 0.15f}, {0.27f, 0.15f, 0.08f}, 3107), true);
  add_fabrics(palette, m);
  m.china = palette.add("china", glazed("china", {0.93f, 0.93f, 0.90f}, 3108));
  m.cup = palette.add("cup", glazed("cup", {0.20f, 0.36f, 0.58f}, 3109));
  m.bowl = palette.add("bowl", majolica());
  m.lemon = palette.add("lemon", terracotta("lemon", {0.96f, 0.80f, 0.16f}, 3110));
  m.steel = palette.add("steel", brushed_metal("steel", {0.90f, 0.89f, 0.87f}, 0.16f, 3111), true);
  m.brass = palette.add("brass", brushed_metal("brass", {0.93f, 0.77f, 0.45f}, 0.24f, 3112), true);
  m.bulb_cord = palette.add_plain("cord", {0.05f, 0.05f, 0.05f}, 0.55f, 0.0f);
  m.painting_frame = palette.add("painting_frame", gold());
  m.toy = palette.add("toy", checker("toy", {0.90f, 0.86f, 0.76f}, {0.74f, 0.13f, 0.10f}, 4, 1.0f));
  for (int k = 0; k < 3; ++k) {
    m.paintings[k] = palette.add("painting_" + std::to_string(k), painting(k));
  }
  // The cloth shade transmits a little light.
  document.materials[std::size_t(m.shade)].emission = glm::vec3(0.75f, 0.48f, 0.22f);
  return m;
}

void add_toy(Document& document, const BreakfastMaterials& m, Animation& objects) {
  constexpr float radius = 0.3f;
  const int mesh = document.add_mesh("toy", icosphere(radius, 4), m.toy);
  const glm::vec3 middle(-1.7f, radius, -1.5f);
  const auto pose = [=](float phase) {
    const float angle = two_pi * phase;
    const float bounce = 0.55f * std::abs(std::sin(3.0f * angle));
    return Pose{middle + glm::vec3(0.6f * std::cos(angle), bounce, 0.6f * std::sin(angle)),
                glm::angleAxis(angle, glm::vec3(0, 1, 0))};
  };
  animate(objects, document.place(mesh, pose(0.0f).translation), pose);
}

}  // namespace

Document make_breakfast_room(const PaperScene& scene, const ClearSky& sky) {
  Document document;
  document.name = scene.name;
  document.description = "A table laid for five in the morning sun behind mullioned windows";
  const BreakfastMaterials materials = add_materials(document);
  document.add_camera("main", breakfast_camera_pose(0.0f).translation, breakfast_target, 56.0f);
  add_sun(document, scene.sun, sky);
  Animation camera{"moving_camera", {}};
  Animation objects{"moving_objects_light", {}};
  animate(camera, find_node(document, "main"), breakfast_camera_pose);
  add_shell(document, materials);
  add_windows(document, materials);
  add_table_and_chairs(document, materials);
  add_paintings(document, materials);
  add_hanging_light(document, materials, objects);
  add_tableware(document, materials);
  add_toy(document, materials, objects);
  swing_sun(document, objects, scene.sun.elevation, scene.sun.azimuth, 20.0f);
  document.animations = {std::move(camera), std::move(objects)};
  return document;
}

}  // namespace heliograph::scenes
