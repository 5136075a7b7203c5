#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "scenes/generator/atrium/atrium_parts.hpp"
#include "scenes/generator/atrium/atrium_plan.hpp"
#include "scenes/generator/geometry/shapes.hpp"
#include "scenes/generator/geometry/transforms.hpp"

namespace heliograph::scenes {
namespace {

constexpr float vault_height = 1.8f;

// Clear spans of the aisles, from the arcade's back to the outer wall.
constexpr glm::vec2 aisle_span = plan::walls - plan::arcade - plan::half_wall;
constexpr glm::vec2 aisle_middle = plan::arcade + plan::half_wall + 0.5f * aisle_span;

// A groin vault: two elliptic barrels of the same height cross. Of each barrel only the part above
// the other one stands, so that every web is a triangle of one cylinder and exactly smooth.
Mesh groin_vault(float width_x, float width_z) {
  Mesh mesh;
  for (int web = 0; web < 4; ++web) {
    const bool along_z = web % 2 == 0;
    const float side = web < 2 ? 1.0f : -1.0f;
    const float across = 0.5f * (along_z ? width_x : width_z);
    const float length = 0.5f * (along_z ? width_z : width_x);
    mesh.append(patch(8, 5, [&](float u, float v) {
      const float reach = 0.5f * pi * v;
      const float angle = (2.0f * u - 1.0f) * reach;
      const float c = across * std::sin(angle);
      const float l = side * length * std::sin(reach);
      const float y = plan::vault_springing + vault_height * std::cos(angle);
      const glm::vec2 slope(-std::sin(angle) / across, -std::cos(angle) / vault_height);
      const glm::vec2 uv(angle * 0.5f * (across + vault_height), l);
      if (along_z) return SurfacePoint{{c, y, l}, {slope.x, slope.y, 0.0f}, uv};
      return SurfacePoint{{l, y, c}, {0.0f, slope.y, slope.x}, uv};
    }));
  }
  return mesh;
}

// A rib under the joint of two vaults: half an ellipse from wall to wall, along local X.
Mesh transverse_rib(float span, float width) {
  Profile profile({0.05f, 0.5f * width});
  profile.line_to({-0.10f, 0.5f * width})
      .arc_to({-0.16f, 0.5f * width - 0.06f}, -0.5f, 4)
      .line_to({-0.16f, 0.06f - 0.5f * width})
      .arc_to({-0.10f, -0.5f * width}, -0.5f, 4)
      .line_to({0.05f, -0.5f * width});
  std::vector<Station> stations;
  constexpr int segments = 14;
  float distance = 0.0f;
  glm::vec3 previous(0.0f);
  for (int i = 0; i <= segments; ++i) {
    const float angle = pi * float(i) / float(segments);
    const glm::vec3 point(0.5f * span * std::cos(angle),
                          plan::vault_springing + vault_height * std::sin(angle), 0.0f);
    const glm::vec3 outwards = glm::normalize(
        glm::vec3(2.0f * std::cos(angle) / span, std::sin(angle) / vault_height, 0.0f));
    if (i > 0) distance += glm::distance(point, previous);
    previous = point;
    stations.push_back({point, outwards, {0.0f, 0.0f, 1.0f}, distance});
  }
  return sweep(profile, stations);
}

glm::vec3 mirrored(glm::vec3 position, int quadrant) {
  return {position.x * (quadrant & 1 ? -1.0f : 1.0f), position.y,
          position.z * (quadrant & 2 ? -1.0f : 1.0f)};
}

}  // namespace

void add_vaults(Document& document, const AtriumMaterials& m) {
  const int side_vault =
      document.add_mesh("vault", groin_vault(plan::bay, aisle_span.y), m.star_vault);
  const int end_vault =
      document.add_mesh("end_vault", groin_vault(aisle_span.x, plan::short_bay), m.star_vault);
  const int corner_vault =
      document.add_mesh("corner_vault", groin_vault(aisle_span.x, aisle_span.y), m.star_vault);
  for (const plan::Spot& spot : plan::bays()) {
    const float side = spot.on_long_side ? spot.position.y : spot.position.x;
    const float outwards = side < 0.0f ? -1.0f : 1.0f;
    if (spot.on_long_side) {
      document.place(side_vault, {spot.position.x, 0.0f, outwards * aisle_middle.y});
    } else {
      document.place(end_vault, {outwards * aisle_middle.x, 0.0f, spot.position.y});
    }
  }
  constexpr float rib_width = plan::wall_thickness + 0.02f;
  const int side_rib =
      document.add_mesh("vault_rib", transverse_rib(aisle_span.y, rib_width), m.trim);
  const int end_rib =
      document.add_mesh("end_vault_rib", transverse_rib(aisle_span.x, rib_width), m.trim);
  for (const plan::Spot& spot : plan::columns()) {
    const float outwards_x = spot.position.x < 0.0f ? -1.0f : 1.0f;
    const float outwards_z = spot.position.y < 0.0f ? -1.0f : 1.0f;
    if (spot.on_long_side) {
      document.place(side_rib, {spot.position.x, 0.0f, outwards_z * aisle_middle.y}, 90.0f);
    } else {
      document.place(end_rib, {outwards_x * aisle_middle.x, 0.0f, spot.position.y});
    }
  }
  for (int quadrant = 0; quadrant < 4; ++quadrant) {
    document.place(corner_vault, mirrored({aisle_middle.x, 0.0f, aisle_middle.y}, quadrant));
    document.place(end_rib, mirrored({aisle_middle.x, 0.0f, plan::arcade.y}, quadrant));
  }
}

namespace {

// A ring of four floors or ceilings between the arcade and the outer walls.
Mesh aisle_ring(float height, bool facing_up, float inner_margin) {
  const glm::vec2 in = plan::arcade - inner_margin;
  const glm::vec2 out = plan::walls;
  const glm::vec3 normal(0.0f, facing_up ? 1.0f : -1.0f, 0.0f);
  const auto rectangle = [&](float x0, float x1, float z0, float z1) {
    Mesh mesh =
        quad_facing({x0, height, z1}, {x1, height, z1}, {x1, height, z0}, {x0, height, z0}, normal);
    // One coordinate frame for the whole ring: joints between the four parts do not show.
    for (Vertex& v : mesh.vertices) v.uv = {v.position.x, facing_up ? v.position.z : -v.position.z};
    return mesh;
  };
  Mesh mesh = rectangle(-out.x, out.x, -out.y, -in.y);
  mesh.append(rectangle(-out.x, out.x, in.y, out.y));
  mesh.append(rectangle(-out.x, -in.x, -in.y, in.y));
  mesh.append(rectangle(in.x, out.x, -in.y, in.y));
  return mesh;
}

constexpr float ceiling_height = 12.75f;

// Main beams at every column line, joists between them at one metre: they frame the painted panels.
Mesh ceiling_beams() {
  Mesh mesh;
  const auto add = [&](glm::vec3 middle, glm::vec3 size) {
    mesh.append(bevelled_box(size, 0.02f), glm::translate(glm::mat4(1.0f), middle));
  };
  const float depth_z = plan::walls.y - plan::arcade.y;
  const float depth_x = plan::walls.x - plan::arcade.x;
  for (const float side : {-1.0f, 1.0f}) {
    for (int i = -20; i <= 20; ++i) {
      const bool main_beam = i % 4 == 0;
      const float height = main_beam ? 0.42f : 0.18f;
      add({float(i), ceiling_height - 0.5f * height, side * (plan::arcade.y + 0.5f * depth_z)},
          {main_beam ? 0.26f : 0.12f, height, depth_z});
    }
    for (int k = 0; k <= 5; ++k) {
      add({0.0f, ceiling_height - 0.08f, side * (plan::arcade.y + float(k))},
          {2.0f * plan::walls.x, 0.16f, 0.12f});
    }
    for (int i = -5; i <= 5; ++i) {
      add({side * (plan::arcade.x + 0.5f * depth_x), ceiling_height - 0.09f, float(i)},
          {depth_x, 0.18f, 0.12f});
    }
    for (int k = 0; k <= 4; ++k) {
      add({side * (plan::arcade.x + float(k)), ceiling_height - 0.08f, 0.0f},
          {0.12f, 0.16f, 2.0f * plan::arcade.y});
    }
  }
  return mesh;
}

}  // namespace

void add_gallery(Document& document, const AtriumMaterials& m) {
  const int floor = document.add_mesh(
      "gallery_floor", aisle_ring(plan::upper.floor, true, plan::half_wall), m.brick);
  document.place(floor, glm::vec3(0.0f));
  const int panels = document.add_mesh("gallery_ceiling", aisle_ring(ceiling_height, false, 0.0f),
                                       m.painted_panel);
  document.place(panels, glm::vec3(0.0f));
  const int beams = document.add_mesh("gallery_beams", ceiling_beams(), m.beam);
  document.place(beams, glm::vec3(0.0f));
}

}  // namespace heliograph::scenes
