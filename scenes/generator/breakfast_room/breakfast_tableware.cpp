#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scenes/generator/breakfast_room/breakfast_parts.hpp"
#include "scenes/generator/geometry/shapes.hpp"

namespace heliograph::scenes {
namespace {

using namespace breakfast;

// Vessels are drawn from the middle of their foot, up the outside, over the rim and down the
// inside.

Mesh plate() {
  Profile profile({0.0f, 0.002f});
  profile.line_to({0.075f, 0.002f})
      .line_to({0.082f, 0.0f})
      .curve_through({{0.10f, 0.010f}, {0.134f, 0.020f}}, 2)
      .arc_to({0.131f, 0.0235f}, 0.8f, 2)
      .curve_through({{0.100f, 0.014f}, {0.080f, 0.007f}, {0.0f, 0.006f}}, 2);
  return lathe(profile, 48, 0.13f, 0.3f);
}

Mesh cup() {
  Profile profile({0.0f, 0.004f});
  profile.line_to({0.022f, 0.004f})
      .line_to({0.024f, 0.0f})
      .curve_through({{0.030f, 0.012f}, {0.040f, 0.040f}, {0.043f, 0.082f}}, 2)
      .arc_to({0.0395f, 0.082f}, 1.0f, 2)
      .curve_through({{0.036f, 0.040f}, {0.026f, 0.014f}, {0.0f, 0.008f}}, 2);
  return lathe(profile, 32, 0.04f, 0.25f);
}

Mesh coffee_pot() {
  Profile profile({0.0f, 0.0f});
  profile.line_to({0.085f, 0.0f})
      .curve_through({{0.115f, 0.05f}, {0.115f, 0.11f}, {0.075f, 0.19f}, {0.062f, 0.235f}}, 4)
      .line_to({0.068f, 0.245f})
      .arc_to({0.016f, 0.272f}, 0.35f, 4)
      .curve_through({{0.012f, 0.282f}, {0.020f, 0.296f}, {0.0f, 0.308f}}, 3);
  Mesh pot = lathe(profile, 64, 0.1f, 0.2f);
  // Handle and spout: a ring cut by the body, and a bent horn.
  pot.append(torus(0.062f, 0.009f, 32, 12),
             glm::translate(glm::mat4(1.0f), {-0.105f, 0.13f, 0.0f}) *
                 glm::rotate(glm::mat4(1.0f), glm::radians(90.0f), glm::vec3(1, 0, 0)));
  pot.append(smooth_patch(20, 8, {0.08f, 0.16f}, [](double u, double v) {
    const double angle = 6.283185307179586 * u;
    const double radius = 0.024 - 0.013 * v;
    const glm::dvec3 middle(0.085 + 0.11 * v, 0.07 + 0.10 * v + 0.07 * v * v, 0.0);
    const glm::dvec3 along = glm::normalize(glm::dvec3(0.11, 0.10 + 0.14 * v, 0.0));
    const glm::dvec3 up(-along.y, along.x, 0.0);
    return middle + radius * (std::cos(angle) * glm::dvec3(0, 0, 1) + std::sin(angle) * up);
  }));
  return pot;
}

Mesh fork() {
  Mesh mesh;
  const auto add = [&](glm::vec3 size, glm::vec3 middle) {
    mesh.append(box(size), glm::translate(glm::mat4(1.0f), middle));
  };
  add({0.010f, 0.003f, 0.11f}, {0.0f, 0.0f, 0.045f});
  add({0.022f, 0.003f, 0.022f}, {0.0f, 0.0f, -0.021f});
  for (int k = -1; k <= 1; ++k) {
    add({0.004f, 0.003f, 0.05f}, {0.009f * float(k), 0.0f, -0.057f});
  }
  return mesh;
}

Mesh bowl() {
  Profile profile({0.0f, 0.0f});
  profile.line_to({0.06f, 0.0f})
      .curve_through({{0.065f, 0.012f}, {0.12f, 0.045f}, {0.155f, 0.09f}}, 2)
      .arc_to({0.149f, 0.09f}, 1.0f, 2)
      .curve_through({{0.112f, 0.05f}, {0.05f, 0.02f}, {0.0f, 0.016f}}, 2);
  return lathe(profile, 48, 0.14f, 1.2f);
}

// An ellipsoid drawn out to a nipple at both ends.
Mesh lemon() {
  Profile profile({0.0f, -0.046f});
  profile.curve_through({{0.008f, -0.042f},
                         {0.024f, -0.028f},
                         {0.031f, 0.0f},
                         {0.024f, 0.028f},
                         {0.008f, 0.042f},
                         {0.0f, 0.046f}},
                        2);
  return lathe(profile, 20, 0.03f, 0.2f);
}

Mesh lemons() {
  Mesh mesh;
  const Mesh one = lemon();
  const glm::vec3 places[] = {
      {0.045f, 0.062f, 0.02f}, {-0.04f, 0.062f, 0.03f}, {0.0f, 0.062f, -0.05f}};
  for (int k = 0; k < 3; ++k) {
    const glm::mat4 turned = glm::rotate(glm::mat4(1.0f), 1.9f * float(k), glm::vec3(0, 1, 0)) *
                             glm::rotate(glm::mat4(1.0f), 1.4f, glm::vec3(0, 0, 1));
    mesh.append(one, glm::translate(glm::mat4(1.0f), places[k]) * turned);
  }
  return mesh;
}

}  // namespace

void add_tableware(Document& document, const BreakfastMaterials& m) {
  const int plate_mesh = document.add_mesh("plate", plate(), m.china);
  const int cup_mesh = document.add_mesh("cup", cup(), m.cup);
  const int handle_mesh = document.add_mesh("cup_handle", torus(0.024f, 0.005f, 24, 12), m.cup);
  const int fork_mesh = document.add_mesh("fork", fork(), m.steel);
  const glm::vec3 top = table_foot + glm::vec3(0.0f, table_height, 0.0f);
  for (int seat = 0; seat < seats; ++seat) {
    const float angle = glm::radians(seat_angle(seat));
    const float turn = 90.0f - seat_angle(seat);
    const glm::vec3 outward(std::cos(angle), 0.0f, std::sin(angle));
    const glm::vec3 right(outward.z, 0.0f, -outward.x);
    document.place(plate_mesh, top + 0.82f * outward, turn);
    const glm::vec3 cup_foot = top + 0.58f * outward + 0.13f * right;
    document.place(cup_mesh, cup_foot, turn);
    // The handle's ring stands upright and points along `right`.
    Node handle;
    handle.name = "cup_handle";
    handle.mesh = handle_mesh;
    handle.translation = cup_foot + 0.052f * right + glm::vec3(0.0f, 0.044f, 0.0f);
    handle.rotation = glm::angleAxis(glm::radians(turn), glm::vec3(0, 1, 0)) *
                      glm::angleAxis(glm::radians(90.0f), glm::vec3(1, 0, 0));
    document.add_node(std::move(handle));
    document.place(fork_mesh, top + 0.82f * outward - 0.18f * right + glm::vec3(0, 0.0025f, 0),
                   turn);
  }
  const int pot = document.add_mesh("coffee_pot", coffee_pot(), m.brass);
  document.place(pot, top + glm::vec3(-0.17f, 0.005f, 0.10f), 205.0f);
  const glm::vec3 bowl_foot = top + glm::vec3(0.2f, 0.005f, -0.16f);
  document.place(document.add_mesh("bowl", bowl(), m.bowl), bowl_foot);
  document.place(document.add_mesh("lemons", lemons(), m.lemon), bowl_foot);
}

}  // namespace heliograph::scenes
