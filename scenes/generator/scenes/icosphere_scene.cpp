#include <cmath>
#include <string>

#include "scenes/generator/geometry/icosphere.hpp"
#include "scenes/generator/geometry/shapes.hpp"
#include "scenes/generator/scenes/clips.hpp"
#include "scenes/generator/scenes/paper_scenes.hpp"
#include "scenes/generator/textures/palette.hpp"
#include "scenes/generator/textures/recipes.hpp"

// A smooth metal sphere among faceted ones: reflectors of every curvature.
namespace heliograph::scenes {
namespace {

constexpr float sphere_radius = 1.5f;
constexpr float facet_radius = 0.8f;
constexpr int facet_levels = 5;
constexpr int icosphere_post_count = 10;
constexpr glm::vec3 icosphere_target(0.0f, 1.4f, 0.0f);

glm::vec3 on_circle(float radius, float height, float angle) {
  return {radius * std::cos(angle), height, radius * std::sin(angle)};
}

void add_icosphere_posts(Document& document, Palette& palette) {
  using namespace recipes;
  const glm::vec3 cream(0.90f, 0.84f, 0.72f);
  const int materials[icosphere_post_count] = {
      palette.add("post_mosaic", mosaic()),
      palette.add("post_red", glazed("post_red", {0.76f, 0.15f, 0.11f}, 2801)),
      palette.add("post_majolica", majolica()),
      palette.add("post_ochre", glazed("post_ochre", {0.88f, 0.60f, 0.14f}, 2802)),
      palette.add("post_stars", star_vault()),
      palette.add("post_green", glazed("post_green", {0.16f, 0.46f, 0.26f}, 2803)),
      palette.add("post_checker", checker("post_checker", cream, {0.14f, 0.16f, 0.20f}, 2, 0.5f)),
      palette.add("post_teal", glazed("post_teal", {0.12f, 0.50f, 0.56f}, 2804)),
      palette.add("post_brick", brick()),
      palette.add("post_blue", glazed("post_blue", {0.14f, 0.22f, 0.60f}, 2805))};
  for (int k = 0; k < icosphere_post_count; ++k) {
    const int mesh =
        document.add_mesh("post_" + std::to_string(k), box({0.7f, 4.0f, 0.7f}), materials[k]);
    const float angle = two_pi * float(k) / float(icosphere_post_count);
    document.place(mesh, on_circle(12.0f, 2.0f, angle), -glm::degrees(angle));
  }
}

}  // namespace

Document make_icosphere_scene(const PaperScene& scene, const ClearSky& sky) {
  Document document;
  document.name = scene.name;
  document.description = "A smooth metal sphere in a ring of faceted ones";
  Palette palette(document);
  document.add_camera("main", {0.0f, 2.5f, 9.0f}, icosphere_target, 50.0f);
  add_sun(document, scene.sun, sky);

  constexpr float half = 20.0f;
  const int tiles = palette.add(
      "floor", recipes::checker("floor", {0.82f, 0.79f, 0.73f}, {0.22f, 0.25f, 0.27f}, 4, 4.0f));
  Mesh floor = quad({-half, 0, half}, {half, 0, half}, {half, 0, -half}, {-half, 0, -half});
  document.place(document.add_mesh("floor", std::move(floor), tiles), glm::vec3(0.0f));

  Animation camera{"moving_camera", {}};
  Animation objects{"moving_objects_light", {}};
  animate(camera, find_node(document, "main"), [](float phase) {
    const float angle = two_pi * phase;
    return look({9.0f * std::sin(angle), 2.5f, 9.0f * std::cos(angle)}, icosphere_target);
  });

  const int metal = palette.add_plain("sphere", {0.92f, 0.90f, 0.86f}, 0.1f, 1.0f, true);
  const int smooth = document.add_mesh("sphere", icosphere(sphere_radius, facet_levels), metal);
  const glm::vec3 middle(0.0f, 1.6f, 0.0f);
  animate(objects, document.place(smooth, middle), [=](float phase) {
    return Pose{middle + glm::vec3(0.0f, 0.8f * there_and_back(phase), 0.0f),
                glm::angleAxis(two_pi * phase, glm::vec3(0, 1, 0))};
  });
  const int warm = palette.add_plain("facets", {0.95f, 0.70f, 0.38f}, 0.1f, 1.0f, true);
  for (int level = 0; level < facet_levels; ++level) {
    const int mesh = document.add_mesh("facets_" + std::to_string(level),
                                       faceted_icosphere(facet_radius, level), warm);
    const float angle = two_pi * (float(level) + 0.75f) / float(facet_levels);
    const glm::vec3 position = on_circle(4.0f, facet_radius, angle);
    const float direction = level % 2 == 0 ? 1.0f : -1.0f;
    animate(objects, document.place(mesh, position), [=](float phase) {
      return Pose{position, glm::angleAxis(direction * two_pi * phase, glm::vec3(0, 1, 0))};
    });
  }
  add_icosphere_posts(document, palette);
  swing_sun(document, objects, scene.sun.elevation, scene.sun.azimuth, 60.0f);
  document.animations = {std::move(camera), std::move(objects)};
  return document;
}

}  // namespace heliograph::scenes
