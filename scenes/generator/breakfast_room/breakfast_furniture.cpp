#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <string>

#include "scenes/generator/breakfast_room/breakfast_parts.hpp"
#include "scenes/generator/geometry/shapes.hpp"

namespace heliograph::scenes {
namespace {

using namespace breakfast;

constexpr float wall_thickness = 0.15f;
constexpr int windows = 4;
constexpr float window_pitch = 1.95f;
constexpr float sill_height = 0.8f;
constexpr float lintel_height = 2.7f;
constexpr float window_height = lintel_height - sill_height;
constexpr float middle_height = 0.5f * (sill_height + lintel_height);
constexpr int slats = 27;

float window_middle(int window) {
  return window_pitch * (float(window) - 0.5f * float(windows - 1));
}

void put(Document& document, const std::string& name, Mesh mesh, int material, glm::vec3 position,
         float turn_degrees = 0.0f) {
  document.place(document.add_mesh(name, std::move(mesh), material), position, turn_degrees);
}

void add_blind(Document& document, int material) {
  // Slats bulge a little and are tilted against the sun.
  const Mesh slat = smooth_patch(8, 2, {1.8f, 0.06f}, [](double u, double v) {
    const double bulge = 0.008 * std::sin(3.14159265358979 * v);
    const double across = (v - 0.5) * 0.06;
    return glm::dvec3(across * 0.8 - bulge * 0.6, across * 0.6 + bulge * 0.8, (0.5 - u) * 1.8);
  });
  const int mesh = document.add_mesh("slat", slat, material);
  for (int k = 0; k < slats; ++k) {
    document.place(mesh, {half_room - 0.13f, 2.66f - 0.03f * float(k), window_middle(0)});
  }
}

Mesh chair_leg(float height) {
  Profile profile({0.015f, 0.0f});
  profile.curve_through({{0.018f, 0.15f * height}, {0.026f, 0.45f * height}}, 2)
      .arc_to({0.026f, 0.52f * height}, 0.5f, 2)
      .curve_through({{0.022f, 0.7f * height}, {0.02f, height}}, 1);
  return lathe(profile, 12, 0.02f, 0.3f);
}

Mesh back_post() {
  Profile profile({0.02f, 0.0f});
  profile.curve_through({{0.022f, 0.25f}, {0.018f, 0.52f}}, 2).arc_to({0.0f, 0.56f}, 0.7f, 3);
  return lathe(profile, 12, 0.02f, 0.3f);
}

// Stuffed: high in the middle, steep at its sides.
Mesh cushion() {
  return smooth_patch(16, 16, {0.46f, 0.46f}, [](double u, double v) {
    const double x = 2.0 * u - 1.0;
    const double z = 2.0 * v - 1.0;
    const double height = 0.05 * (1.0 - x * x * x * x * x * x) * (1.0 - z * z * z * z * z * z);
    return glm::dvec3(0.22 * x, height, -0.22 * z);
  });
}

struct ChairMeshes {
  int base, cushion, leg, post, rail;
};

ChairMeshes add_chair_meshes(Document& document, const BreakfastMaterials& m) {
  return {document.add_mesh("seat", bevelled_box({0.46f, 0.04f, 0.46f}, 0.006f), m.chair),
          document.add_mesh("cushion", cushion(), m.cushion),
          document.add_mesh("chair_leg", chair_leg(0.43f), m.chair),
          document.add_mesh("chair_post", back_post(), m.chair),
          document.add_mesh("chair_rail", bevelled_box({0.40f, 0.05f, 0.02f}, 0.004f), m.chair)};
}

/// The chair's own +Z points away from the table.
void add_chair(Document& document, const ChairMeshes& meshes, int seat) {
  const float angle = glm::radians(seat_angle(seat));
  const float turn = 90.0f - seat_angle(seat);
  const glm::vec3 outward(std::cos(angle), 0.0f, std::sin(angle));
  const glm::vec3 right(outward.z, 0.0f, -outward.x);
  // The one nearest the camera is pushed back a little, as if a guest had just left it.
  const float distance = seat == 1 ? 1.62f : 1.42f;
  const auto place = [&](int mesh, float x, float y, float z) {
    const glm::vec3 position = table_foot + outward * (distance + z) + right * x;
    document.place(mesh, position + glm::vec3(0.0f, y, 0.0f), turn);
  };
  place(meshes.base, 0.0f, 0.45f, 0.0f);
  place(meshes.cushion, 0.0f, 0.47f, 0.0f);
  for (const float x : {-0.2f, 0.2f}) {
    for (const float z : {-0.2f, 0.2f}) place(meshes.leg, x, 0.0f, z);
    place(meshes.post, x, 0.47f, 0.21f);
  }
  for (const float y : {0.62f, 0.74f, 0.86f, 0.97f}) place(meshes.rail, 0.0f, y, 0.21f);
}

}  // namespace

void add_shell(Document& document, const BreakfastMaterials& m) {
  constexpr float side = 2.0f * half_room;
  constexpr float outside = half_room + 0.5f * wall_thickness;
  constexpr float middle = 0.5f * room_height;
  put(document, "floor",
      quad({-half_room, 0, half_room}, {half_room, 0, half_room}, {half_room, 0, -half_room},
           {-half_room, 0, -half_room}),
      m.floor, glm::vec3(0.0f));
  put(document, "ceiling", box({side + 0.3f, 0.1f, side + 0.3f}), m.ceiling,
      {0.0f, room_height + 0.05f, 0.0f});
  put(document, "north_wall", box({side, room_height, wall_thickness}), m.accent,
      {0.0f, middle, -outside});
  put(document, "south_wall", box({side, room_height, wall_thickness}), m.plaster,
      {0.0f, middle, outside});
  put(document, "west_wall", box({wall_thickness, room_height, side}), m.plaster,
      {-outside, middle, 0.0f});
  put(document, "sill_wall", box({wall_thickness, sill_height, side}), m.plaster,
      {outside, 0.5f * sill_height, 0.0f});
  put(document, "lintel_wall", box({wall_thickness, room_height - lintel_height, side}), m.plaster,
      {outside, 0.5f * (room_height + lintel_height), 0.0f});
  put(document, "rug", bevelled_box({3.6f, 0.016f, 3.2f}, 0.006f), m.rug,
      table_foot + glm::vec3(0.0f, 0.008f, 0.0f));
}

void add_windows(Document& document, const BreakfastMaterials& m) {
  constexpr float x = half_room + 0.5f * wall_thickness;
  const int jamb = document.add_mesh("jamb", box({0.18f, window_height, 0.24f}), m.frame);
  const int upright = document.add_mesh("mullion", box({0.06f, window_height, 0.035f}), m.frame);
  const int bar = document.add_mesh("glazing_bar", box({0.05f, 0.035f, window_pitch}), m.frame);
  for (int k = 0; k <= windows; ++k) {
    document.place(jamb, {x, middle_height, window_middle(k) - 0.5f * window_pitch});
  }
  for (int window = 0; window < windows; ++window) {
    const float z = window_middle(window);
    for (int k = -1; k <= 1; ++k) document.place(upright, {x, middle_height, z + 0.43f * float(k)});
    for (int k = 0; k < 5; ++k) {
      document.place(bar, {x, sill_height + window_height * float(k) / 4.0f, z});
    }
  }
  add_blind(document, m.slat);
}

void add_table_and_chairs(Document& document, const BreakfastMaterials& m) {
  Profile top({0.0f, table_height - 0.04f});
  top.line_to({table_radius - 0.05f, table_height - 0.04f})
      .arc_to({table_radius - 0.008f, table_height}, 0.5f, 5)
      .line_to({0.0f, table_height});
  put(document, "table_top", lathe(top, 64, table_radius, 1.2f), m.table, table_foot);
  Profile leg({0.42f, 0.0f});
  leg.line_to({0.42f, 0.04f})
      .curve_through({{0.20f, 0.10f}, {0.09f, 0.20f}, {0.075f, 0.34f}}, 3)
      .arc_to({0.085f, 0.44f}, 0.7f, 4)
      .curve_through({{0.10f, 0.56f}, {0.22f, 0.68f}, {0.34f, table_height - 0.04f}}, 3);
  put(document, "table_leg", lathe(leg, 40, 0.1f, 0.3f), m.table, table_foot);

  Profile fall({table_radius + 0.008f, table_height - 0.22f});
  fall.line_by({0.0f, 0.205f})
      .arc_to({table_radius - 0.012f, table_height + 0.004f}, 0.414f, 4)
      .line_to({-table_radius + 0.012f, table_height + 0.004f})
      .arc_to({-table_radius - 0.008f, table_height - 0.015f}, 0.414f, 4)
      .line_by({0.0f, -0.205f});
  put(document, "runner", sweep(fall, straight_stations(0.36f)), m.runner, table_foot, 40.0f);

  const ChairMeshes meshes = add_chair_meshes(document, m);
  for (int seat = 0; seat < seats; ++seat) add_chair(document, meshes, seat);
}

void add_paintings(Document& document, const BreakfastMaterials& m) {
  constexpr glm::vec2 half(0.40f, 0.30f);
  Profile moulding({0.07f, 0.0f});
  moulding.line_to({0.07f, 0.03f}).arc_to({0.02f, 0.045f}, 0.5f, 3).line_to({0.0f, 0.012f});
  // Mouldings lie in the floor's plane: raise this one against the wall.
  const glm::mat4 upright =
      glm::rotate(glm::mat4(1.0f), glm::radians(90.0f), glm::vec3(1.0f, 0.0f, 0.0f));
  Mesh frame;
  frame.append(rectangular_moulding(moulding, half), upright);
  const int frame_mesh = document.add_mesh("painting_frame", std::move(frame), m.painting_frame);
  for (int k = 0; k < 3; ++k) {
    const glm::vec3 middle(-2.4f + 2.2f * float(k), 1.75f, -half_room + 0.002f);
    document.place(frame_mesh, middle);
    Mesh canvas = quad({-half.x, -half.y, 0.012f}, {half.x, -half.y, 0.012f},
                       {half.x, half.y, 0.012f}, {-half.x, half.y, 0.012f});
    for (Vertex& vertex : canvas.vertices) vertex.uv /= 2.0f * half;
    put(document, "painting_" + std::to_string(k), std::move(canvas), m.paintings[k], middle);
  }
}

void add_hanging_light(Document& document, const BreakfastMaterials& m, Animation& objects) {
  Profile profile({0.30f, 0.0f});
  profile.curve_through({{0.24f, 0.14f}, {0.12f, 0.26f}}, 3).line_to({0.03f, 0.27f});
  const int shade = document.add_mesh("lamp_shade", lathe(profile, 64, 0.25f, 0.6f), m.shade);
  const glm::vec3 rim = table_foot + glm::vec3(0.0f, 1.72f, 0.0f);
  Light light;
  light.name = "hanging_light";
  light.color = {1.0f, 0.72f, 0.42f};
  light.intensity = 3.2f;
  light.range = 8.0f;
  Node bulb;
  const glm::vec3 inside(0.0f, 0.08f, 0.0f);
  bulb.translation = rim + inside;
  const int nodes[] = {document.place(shade, rim), document.add_light(light, bulb)};
  for (const int node : nodes) {
    const glm::vec3 base = document.nodes[std::size_t(node)].translation;
    animate(objects, node, [=](float phase) {
      return Pose{base + glm::vec3(0.0f, 0.1f * std::sin(two_pi * phase), 0.0f), {1, 0, 0, 0}};
    });
  }
  Profile cord({0.006f, 0.0f});
  cord.line_to({0.006f, 1.05f}).line_to({0.05f, 1.10f}).line_to({0.05f, 1.13f});
  put(document, "light_cord", lathe(cord, 12, 0.01f, 0.2f), m.bulb_cord,
      {table_foot.x, room_height - 1.13f, table_foot.z});
}

}  // namespace heliograph::scenes
