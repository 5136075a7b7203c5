#include "scenes/generator/scenes/material_balls.hpp"

#include <cmath>
#include <tuple>
#include <utility>

#include "scenes/generator/geometry/shapes.hpp"
#include "scenes/generator/geometry/transforms.hpp"
#include "scenes/generator/sky/studio.hpp"

namespace heliograph::scenes {
namespace {

constexpr float ball_radius = 0.5f;
// Of a ball's square in the image of its row, so that the ball is seven tenths of it.
constexpr float ball_pitch = 1.4f;
// Seen from 30 degrees above, rows are half as far apart: just outside of each other's images.
constexpr float row_pitch = 2.6f;
constexpr float camera_elevation = 30.0f;
constexpr float row_camera_distance = 20.0f;
constexpr float main_camera_distance = 60.0f;
constexpr float main_camera_fov = 14.0f;
constexpr std::size_t rows_per_block = 8;
constexpr float block_pitch = float(balls_per_row) * ball_pitch + 0.5f * ball_pitch;
constexpr int ground_tiles = 70;  // in both directions
constexpr float tile_width = 0.5f * ball_pitch;

glm::vec3 row_middle(std::size_t row) {
  const auto block = float(row / rows_per_block);
  const auto line = float(row % rows_per_block);
  return {(block - 1.0f) * block_pitch, ball_radius,
          (line - 0.5f * float(rows_per_block - 1)) * row_pitch};
}

void add_viewpoint(Document& document, const std::string& name, glm::vec3 target, float distance,
                   float vertical_fov_degrees) {
  const glm::vec3 outward = direction_to_sun(camera_elevation, 0.0f);
  document.add_camera(name, target + distance * outward, target, vertical_fov_degrees);
}

/// Two grays, so that what is seen through a ball has edges that are bent or blurred.
void add_ground(Document& document) {
  for (const auto& [parity, name, gray] :
       {std::tuple{0, "ground_light", 0.45f}, std::tuple{1, "ground_dark", 0.3f}}) {
    Material material;
    material.name = name;
    material.color = glm::vec3(gray);
    material.roughness = 0.9f;
    material.metallic = 0.0f;
    Mesh tiles;
    const Mesh tile =
        quad({0, 0, tile_width}, {tile_width, 0, tile_width}, {tile_width, 0, 0}, {0, 0, 0});
    for (int x = 0; x < ground_tiles; ++x) {
      for (int z = 0; z < ground_tiles; ++z) {
        if ((x + z) % 2 != parity) continue;
        tiles.append(tile, moved(tile_width * (glm::vec3(float(x), 0.0f, float(z)) -
                                               0.5f * float(ground_tiles) * glm::vec3(1, 0, 1))));
      }
    }
    document.place(
        document.add_mesh(name, std::move(tiles), document.add_material(std::move(material))),
        glm::vec3(0.0f));
  }
}

/// Small beside the soft boxes: highlights show the lobes of rough and brushed surfaces.
void add_key_light(Document& document) {
  Light light;
  light.name = "key";
  light.directional = true;
  light.intensity = 1.5f;
  Node node;
  node.translation = 10.0f * direction_to_sun(50.0f, 35.0f);
  node.rotation = look_rotation(node.translation, glm::vec3(0.0f));
  node.angular_diameter = 5.0f;
  document.add_light(std::move(light), std::move(node));
}

void add_row(Document& document, BallRow row, glm::vec3 middle) {
  for (std::size_t i = 0; i < row.materials.size(); ++i) {
    const std::string name = row.materials[i].name;
    const int material = document.add_material(std::move(row.materials[i]));
    // Surface in metres, so that a masked pattern has the same size everywhere.
    Mesh ball = sphere(ball_radius, 64, 32, glm::vec2(two_pi, pi) * ball_radius);
    const float offset = float(i) - 0.5f * float(balls_per_row - 1);
    document.place(document.add_mesh(name, std::move(ball), material),
                   middle + glm::vec3(offset * ball_pitch, 0.0f, 0.0f));
  }
}

}  // namespace

Document make_material_balls() {
  Document document;
  document.name = "material_balls";
  document.description = "Rows of five balls: one property of glTF's materials each";
  add_viewpoint(document, "main", {0.0f, ball_radius, 0.0f}, main_camera_distance, main_camera_fov);
  add_ground(document);
  add_key_light(document);
  const float row_fov = 2.0f * glm::degrees(std::atan(0.5f * ball_pitch / row_camera_distance));
  std::size_t count = 0;
  for (BallRow& row : ball_rows()) {
    const glm::vec3 middle = row_middle(count++);
    add_viewpoint(document, row.name, middle, row_camera_distance, row_fov);
    add_row(document, std::move(row), middle);
  }
  return document;
}

Environment make_material_balls_environment() {
  return make_studio(512, 256);
}

}  // namespace heliograph::scenes
