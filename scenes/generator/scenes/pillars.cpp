#include <array>
#include <cmath>
#include <string>

#include "scenes/generator/geometry/shapes.hpp"
#include "scenes/generator/scenes/clips.hpp"
#include "scenes/generator/scenes/paper_scenes.hpp"
#include "scenes/generator/textures/palette.hpp"
#include "scenes/generator/textures/recipes.hpp"

// A grove of pillars under a low sun: long shadows that cross and grow softer as they go.
namespace heliograph::scenes {
namespace {

constexpr int columns = 12;
constexpr int rows = 6;
constexpr int heights = 6;
constexpr glm::vec3 pillars_target(0.0f, 1.4f, -8.0f);

/// Base, shaft with a slight swelling, capital; `height` metres in all.
Mesh pillar(float height) {
  Profile profile({0.58f, 0.0f});
  profile.line_to({0.58f, 0.16f})
      .arc_to({0.44f, 0.36f}, 0.8f, 3)
      .curve_through({{0.42f, 0.45f * height}, {0.36f, height - 0.50f}}, 1)
      .arc_to({0.56f, height - 0.20f}, -0.6f, 2)
      .line_to({0.56f, height})
      .line_to({0.0f, height});
  return lathe(profile, 32, 0.45f, 1.2f);
}

std::array<int, heights> pillar_materials(Palette& palette) {
  using namespace recipes;
  const auto stone = [&](const std::string& name, glm::vec3 ground, glm::vec3 cloud, glm::vec3 vein,
                         std::uint32_t seed) {
    return palette.add(name, marble({name, ground, cloud, vein, 0.55f, 0.30f, seed}, 1.2f));
  };
  return {
      stone("pillar_white", {0.90f, 0.87f, 0.81f}, {0.83f, 0.78f, 0.70f}, {0.56f, 0.50f, 0.45f},
            31),
      palette.add("pillar_limestone",
                  smooth_limestone("pillar_limestone", {0.87f, 0.78f, 0.62f}, 3001)),
      stone("pillar_red", {0.56f, 0.24f, 0.18f}, {0.46f, 0.19f, 0.15f}, {0.86f, 0.72f, 0.64f}, 32),
      stone("pillar_green", {0.22f, 0.36f, 0.29f}, {0.30f, 0.44f, 0.36f}, {0.72f, 0.78f, 0.70f},
            33),
      palette.add("pillar_clay", terracotta("pillar_clay", {0.76f, 0.47f, 0.32f}, 3002)),
      stone("pillar_ochre", {0.80f, 0.62f, 0.36f}, {0.70f, 0.50f, 0.28f}, {0.92f, 0.84f, 0.70f},
            34)};
}

void add_pillars(Document& document, Palette& palette) {
  const std::array<int, heights> materials = pillar_materials(palette);
  std::array<int, heights> meshes{};
  for (int k = 0; k < heights; ++k) {
    const float height = 6.0f * (0.70f + 0.08f * float(k));
    meshes[std::size_t(k)] =
        document.add_mesh("pillar_" + std::to_string(k), pillar(height), materials[std::size_t(k)]);
  }
  for (int i = 0; i < columns; ++i) {
    for (int j = 0; j < rows; ++j) {
      const int kind = (7 * i + 3 * j) % heights;
      // Every pillar shows another side of its stone.
      document.place(meshes[std::size_t(kind)],
                     {-16.5f + 3.0f * float(i), 0.0f, -2.0f - 3.5f * float(j)},
                     37.0f * float(i + 5 * j));
    }
  }
}

void add_balls(Document& document, Palette& palette, Animation& objects) {
  const int materials[] = {
      palette.add("ball_gold", recipes::gold()), palette.add("ball_majolica", recipes::majolica()),
      palette.add("ball_copper",
                  recipes::brushed_metal("ball_copper", {0.93f, 0.62f, 0.48f}, 0.22f, 3003)),
      palette.add("ball_mosaic", recipes::mosaic())};
  for (int k = 0; k < 4; ++k) {
    const Mesh ball = sphere(1.0f, 60, 38, {6.0f, 3.0f});
    const int mesh = document.add_mesh("ball_" + std::to_string(k), ball, materials[k]);
    const glm::vec3 position(-9.0f + 6.0f * float(k), 3.0f, 1.0f);
    animate(objects, document.place(mesh, position), [=](float phase) {
      const float height = 1.5f * std::sin(two_pi * phase + 1.6f * float(k));
      return Pose{position + glm::vec3(0.0f, height, 0.0f),
                  glm::angleAxis(two_pi * phase, glm::vec3(0, 1, 0))};
    });
  }
}

}  // namespace

Document make_pillars(const PaperScene& scene, const ClearSky& sky) {
  Document document;
  document.name = scene.name;
  document.description = "72 pillars of six heights under a low sun";
  Palette palette(document);
  document.add_camera("main", {0.0f, 3.6f, 9.5f}, pillars_target, 52.0f);
  add_sun(document, scene.sun, sky);
  Animation camera{"moving_camera", {}};
  Animation objects{"moving_objects_light", {}};
  animate(camera, find_node(document, "main"), [](float phase) {
    return look({8.0f * std::sin(two_pi * phase), 3.6f, 9.5f}, pillars_target);
  });

  constexpr float half = 40.0f;
  const int slabs =
      palette.add("floor", recipes::concrete_slabs("floor", {0.72f, 0.66f, 0.57f}, 4.0f));
  Mesh floor = quad({-half, 0, half}, {half, 0, half}, {half, 0, -half}, {-half, 0, -half});
  document.place(document.add_mesh("floor", std::move(floor), slabs), glm::vec3(0.0f));
  add_pillars(document, palette);
  add_balls(document, palette, objects);
  swing_sun(document, objects, scene.sun.elevation, scene.sun.azimuth, 40.0f);
  document.animations = {std::move(camera), std::move(objects)};
  return document;
}

}  // namespace heliograph::scenes
