#include <cmath>
#include <string>

#include "scenes/generator/geometry/icosphere.hpp"
#include "scenes/generator/geometry/shapes.hpp"
#include "scenes/generator/scenes/clips.hpp"
#include "scenes/generator/scenes/paper_scenes.hpp"
#include "scenes/generator/textures/palette.hpp"
#include "scenes/generator/textures/recipes.hpp"

// Thin and thick shapes at various distances from their shadows: every width of penumbra.
namespace heliograph::scenes {
namespace {

constexpr glm::vec3 shadow_objects_target(0.0f, 1.2f, 0.0f);
constexpr int bar_count = 12;

Mesh pole() {
  Profile profile({0.24f, 0.0f});
  profile.line_to({0.24f, 0.05f})
      .line_to({0.06f, 0.08f})
      .line_to({0.06f, 3.84f})
      .line_to({0.045f, 3.86f})
      .arc_to({0.0f, 4.06f}, 1.1f, 8);
  return lathe(profile, 16, 0.06f, 0.2f);
}

// A sphere pushed in and out by a wave of its direction, r = 1 + a sin(fx) sin(fy) sin(fz).
Mesh blob() {
  constexpr float amplitude = 0.3f;
  constexpr float frequency = 6.0f;
  return icosphere(4, {6.0f, 3.0f}, [](glm::vec3 d) {
    const glm::vec3 s = glm::sin(frequency * d);
    const glm::vec3 c = glm::cos(frequency * d);
    const float radius = 1.0f + amplitude * s.x * s.y * s.z;
    const glm::vec3 gradient =
        amplitude * frequency * glm::vec3(c.x * s.y * s.z, s.x * c.y * s.z, s.x * s.y * c.z);
    // The normal of r(d) d: along d, less the part of the gradient that lies in the sphere.
    const glm::vec3 in_sphere = gradient - d * glm::dot(d, gradient);
    return SurfacePoint{radius * d, glm::normalize(radius * d - in_sphere), {}};
  });
}

class Exhibition {
 public:
  Exhibition(Document& document, Animation& objects) : document_(document), objects_(objects) {}

  void add_still(const std::string& name, Mesh mesh, int material, glm::vec3 position) {
    document_.place(document_.add_mesh(name, std::move(mesh), material), position);
  }

  /// Turns once in a loop and bobs by `bob` metres, out of step with the others.
  void add_moving(const std::string& name, Mesh mesh, int material, glm::vec3 position,
                  glm::vec3 axis, float bob) {
    const int node = document_.place(document_.add_mesh(name, std::move(mesh), material), position);
    const float offset = float(node);
    animate(objects_, node, [=](float phase) {
      return Pose{position + glm::vec3(0.0f, bob * std::sin(two_pi * phase + offset), 0.0f),
                  glm::angleAxis(two_pi * phase, axis)};
    });
  }

 private:
  Document& document_;
  Animation& objects_;
};

void add_objects(Exhibition& exhibition, Palette& palette) {
  using namespace recipes;
  const glm::vec3 up(0.0f, 1.0f, 0.0f);
  const int red = palette.add("red", glazed("red", {0.74f, 0.16f, 0.12f}, 2901));
  const int green = palette.add("green", glazed("green", {0.24f, 0.48f, 0.26f}, 2902));
  const int checkered = palette.add(
      "checkered", checker("checkered", {0.90f, 0.87f, 0.80f}, {0.16f, 0.30f, 0.56f}, 4, 1.0f));
  const int brass =
      palette.add("brass", brushed_metal("brass", {0.90f, 0.74f, 0.44f}, 0.28f, 2903));
  const int clay = palette.add("clay", terracotta("clay", {0.74f, 0.44f, 0.30f}, 2904));
  const int stone = palette.add("stone", smooth_limestone("stone", {0.88f, 0.82f, 0.72f}, 2905));
  const int woven = palette.add("lattice", lattice());
  const int oak =
      palette.add("oak", wood("oak", {0.62f, 0.44f, 0.27f}, {0.40f, 0.26f, 0.15f}, 2906));

  exhibition.add_still("pole", pole(), red, {-8.0f, 0.0f, 0.0f});
  exhibition.add_moving("low_cube", box(glm::vec3(1.2f)), checkered, {-5.2f, 0.95f, 0.4f}, up,
                        0.3f);
  exhibition.add_moving("high_cube", box(glm::vec3(1.0f)), green, {-5.0f, 3.0f, -3.0f}, up, 0.4f);
  exhibition.add_moving("torus", torus(0.9f, 0.25f, 48, 24), brass, {-2.0f, 1.6f, 0.0f},
                        {1.0f, 0.0f, 0.0f}, 0.3f);
  exhibition.add_moving("low_sphere", icosphere(1.0f, 4), clay, {1.0f, 1.4f, 0.0f}, up, 0.4f);
  exhibition.add_moving("high_sphere", icosphere(0.6f, 4), brass, {1.4f, 3.4f, -3.0f}, up, 0.4f);
  exhibition.add_still("lattice", quad({-1.5f, 0, 0}, {1.5f, 0, 0}, {1.5f, 3, 0}, {-1.5f, 3, 0}),
                       woven, {4.4f, 0.0f, 0.2f});
  exhibition.add_moving("blob", blob(), stone, {7.6f, 1.7f, 0.0f}, up, 0.3f);
  for (int k = 0; k < bar_count; ++k) {
    exhibition.add_still("bar_" + std::to_string(k), box({0.05f, 2.5f, 0.05f}), oak,
                         {-9.0f + 0.3f * float(k), 1.25f, 3.0f});
  }
}

}  // namespace

Document make_shadow_objects(const PaperScene& scene, const ClearSky& sky) {
  Document document;
  document.name = scene.name;
  document.description = "Shapes that throw shadows of every sharpness on a floor and a wall";
  Palette palette(document);
  document.add_camera("main", {0.0f, 5.0f, 13.0f}, shadow_objects_target, 50.0f);
  add_sun(document, scene.sun, sky);
  Animation camera{"moving_camera", {}};
  Animation objects{"moving_objects_light", {}};
  animate(camera, find_node(document, "main"), [](float phase) {
    const glm::vec3 eye(5.0f * std::sin(two_pi * phase), 5.0f,
                        13.0f - 2.0f * there_and_back(phase));
    return look(eye, shadow_objects_target);
  });

  constexpr float half = 20.0f;
  Exhibition exhibition(document, objects);
  const int slabs =
      palette.add("floor", recipes::concrete_slabs("floor", {0.72f, 0.70f, 0.67f}, 4.0f));
  const int wall = palette.add("wall", recipes::ashlar("wall", {0.74f, 0.64f, 0.52f}, 2907));
  exhibition.add_still("floor",
                       quad({-half, 0, half}, {half, 0, half}, {half, 0, -half}, {-half, 0, -half}),
                       slabs, glm::vec3(0.0f));
  exhibition.add_still("wall", box({2.0f * half, 5.4f, 0.4f}), wall, {0.0f, 2.7f, -8.0f});
  add_objects(exhibition, palette);
  swing_sun(document, objects, scene.sun.elevation, scene.sun.azimuth, 60.0f);
  document.animations = {std::move(camera), std::move(objects)};
  return document;
}

}  // namespace heliograph::scenes
