#include "scenes/generator/scenes/test_scenes.hpp"

#include <algorithm>
#include <cstdio>

#include "scenes/generator/geometry/shapes.hpp"

namespace heliograph::scenes {
namespace {

constexpr float radius = 0.45f;

int add_sphere(Document& document, const std::string& name, glm::vec3 color, float roughness,
               float metallic, glm::vec3 position) {
  Material material;
  material.name = name;
  material.color = color;
  material.roughness = roughness;
  material.metallic = metallic;
  const int index = document.add_material(std::move(material));
  const int mesh = document.add_mesh(name, sphere(radius, 96, 48, glm::vec2(1.0f)), index);
  return document.place(mesh, position);
}

}  // namespace

Document make_furnace() {
  Document document;
  document.name = "furnace";
  document.description = "White furnace: one diffuse and five metal spheres of base colour 1";
  add_sphere(document, "diffuse", glm::vec3(1.0f), 1.0f, 0.0f, {0.0f, 0.6f, 0.0f});
  for (int i = 0; i < 5; ++i) {
    char name[16];
    std::snprintf(name, sizeof name, "metal_%03d", 25 * i);
    add_sphere(document, name, glm::vec3(1.0f), 0.25f * float(i), 1.0f,
               {float(i) - 2.0f, -0.6f, 0.0f});
  }
  document.add_camera("main", {0.0f, 0.0f, 6.0f}, {0.0f, 0.0f, 0.0f}, 36.0f);
  return document;
}

Document make_mirror() {
  Document document;
  document.name = "mirror";
  document.description = "A mirror sphere over a mirror plane; the camera looks down on both";
  const int ball =
      add_sphere(document, "mirror", glm::vec3(1.0f), 0.0f, 1.0f, {0.0f, radius, 0.0f});
  const int material =
      document.meshes[std::size_t(document.nodes[std::size_t(ball)].mesh)].material;
  Mesh plane = quad({-4, 0, 4}, {4, 0, 4}, {4, 0, -4}, {-4, 0, -4});
  document.place(document.add_mesh("plane", std::move(plane), material), glm::vec3(0.0f));
  document.add_camera("main", {0.0f, 1.4f, 3.2f}, {0.0f, 0.35f, 0.0f}, 40.0f);
  return document;
}

Environment make_white_environment() {
  Environment white(64, 32);
  std::fill(white.radiance.begin(), white.radiance.end(), glm::vec3(1.0f));
  return white;
}

}  // namespace heliograph::scenes
