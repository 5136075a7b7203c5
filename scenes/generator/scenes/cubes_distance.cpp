#include <cmath>
#include <string>
#include <vector>

#include "scenes/generator/geometry/shapes.hpp"
#include "scenes/generator/scenes/clips.hpp"
#include "scenes/generator/scenes/paper_scenes.hpp"
#include "scenes/generator/textures/palette.hpp"
#include "scenes/generator/textures/recipes.hpp"

// Cubes at increasing heights over a metal floor: a rough floor blurs each reflection by a
// different amount.
namespace heliograph::scenes {
namespace {

constexpr float floor_size = 60.0f;
constexpr int cube_count = 8;
constexpr int cubes_post_count = 6;
constexpr glm::vec3 cubes_target(0.0f, 0.8f, -8.0f);

Pose cubes_camera_pose(float phase) {
  const float angle = two_pi * phase;
  const glm::vec3 eye(4.0f * std::sin(angle), 2.2f + 0.4f * std::sin(2.0f * angle),
                      8.0f - 2.0f * there_and_back(phase));
  return look(eye, cubes_target);
}

std::vector<int> cube_materials(Palette& palette) {
  using namespace recipes;
  const glm::vec3 ivory(0.90f, 0.87f, 0.80f);
  const MarbleLook red{"cube_marble",
                       {0.55f, 0.20f, 0.15f},
                       {0.64f, 0.30f, 0.22f},
                       {0.88f, 0.76f, 0.68f},
                       0.65f,
                       0.15f,
                       6};
  return {
      palette.add("cube_red_checker", checker("cube_red", ivory, {0.72f, 0.13f, 0.10f}, 4, 1)),
      palette.add("cube_mosaic", mosaic()),
      palette.add("cube_blue_checker", checker("cube_blue", ivory, {0.11f, 0.28f, 0.62f}, 4, 1)),
      palette.add("cube_majolica", majolica()),
      palette.add("cube_green_checker", checker("cube_green", ivory, {0.10f, 0.42f, 0.24f}, 4, 1)),
      palette.add("cube_stars", star_vault()),
      palette.add("cube_ochre_checker", checker("cube_ochre", ivory, {0.86f, 0.56f, 0.12f}, 4, 1)),
      palette.add("cube_marble", marble(red, 1.0f))};
}

void add_cubes_posts(Document& document, Palette& palette) {
  const glm::vec3 colors[cubes_post_count] = {{0.78f, 0.20f, 0.14f}, {0.86f, 0.58f, 0.16f},
                                              {0.28f, 0.52f, 0.24f}, {0.14f, 0.46f, 0.52f},
                                              {0.18f, 0.28f, 0.62f}, {0.50f, 0.22f, 0.46f}};
  for (int k = 0; k < cubes_post_count; ++k) {
    const std::string name = "post_" + std::to_string(k);
    const int material =
        palette.add(name, recipes::glazed(name, colors[k], 2700 + std::uint32_t(k)));
    const float height = 1.0f + 0.8f * float(k);
    const int mesh = document.add_mesh(name, box({1.0f, height, 1.0f}), material);
    document.place(mesh, {-15.0f + 6.0f * float(k), 0.5f * height, -26.0f});
  }
}

}  // namespace

Document make_cubes_distance(const PaperScene& scene, const ClearSky& sky) {
  Document document;
  document.name = scene.name;
  document.description = "Cubes at growing heights and distances over a metal floor";
  Palette palette(document);
  document.add_camera("main", {0.0f, 2.2f, 8.0f}, cubes_target, 42.0f);
  add_sun(document, scene.sun, sky);

  const int metal =
      palette.add("floor", recipes::metal_panels("floor", {0.80f, 0.80f, 0.82f}, 0.2f, 3.0f), true);
  constexpr float half = 0.5f * floor_size;
  Mesh floor = quad({-half, 0, half}, {half, 0, half}, {half, 0, -half}, {-half, 0, -half});
  document.place(document.add_mesh("floor", std::move(floor), metal), glm::vec3(0.0f));

  Animation camera{"moving_camera", {}};
  Animation objects{"moving_objects_light", {}};
  animate(camera, find_node(document, "main"), cubes_camera_pose);
  const std::vector<int> materials = cube_materials(palette);
  for (int k = 0; k < cube_count; ++k) {
    const std::string name = "cube_" + std::to_string(k);
    const glm::vec3 position(-5.6f + 1.6f * float(k), 0.5f + 0.35f * float(k),
                             -2.0f - 2.5f * float(k));
    const int mesh = document.add_mesh(name, box(glm::vec3(1.0f)), materials[std::size_t(k)]);
    const float direction = k % 2 == 0 ? -1.0f : 1.0f;
    const float bob = 0.3f * float(k % 3);
    animate(objects, document.place(mesh, position), [=](float phase) {
      const float height = bob * std::sin(two_pi * phase + float(k));
      return Pose{position + glm::vec3(0.0f, height, 0.0f),
                  glm::angleAxis(direction * two_pi * phase, glm::vec3(0, 1, 0))};
    });
  }
  add_cubes_posts(document, palette);
  swing_sun(document, objects, scene.sun.elevation, scene.sun.azimuth, 60.0f);
  document.animations = {std::move(camera), std::move(objects)};
  return document;
}

}  // namespace heliograph::scenes
