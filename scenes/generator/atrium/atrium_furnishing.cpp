#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "scenes/generator/atrium/atrium_parts.hpp"
#include "scenes/generator/atrium/atrium_plan.hpp"
#include "scenes/generator/geometry/shapes.hpp"
#include "scenes/generator/geometry/transforms.hpp"

namespace heliograph::scenes {
namespace {

constexpr double period = 2.0 * glm::pi<double>();

Mesh rod(float radius, float length, int segments) {
  Profile profile({radius, 0.0f});
  profile.line_to({radius, length});
  return lathe(profile, segments, radius, 0.6f);
}

// Oval links, each turned a quarter against the last, hanging down from the origin.
Mesh chain(float length) {
  constexpr float pitch = 0.088f;
  Mesh link = torus(0.030f, 0.008f, 7, 4);
  Mesh mesh;
  for (int i = 0; i < int(length / pitch); ++i) {
    glm::mat4 place = moved({0.0f, -(float(i) + 0.5f) * pitch, 0.0f});
    place = place * turned(i % 2 == 0 ? 0.0f : 0.5f * pi, {0, 1, 0});
    place = place * turned(0.5f * pi, {1, 0, 0});
    mesh.append(link, glm::scale(place, {1.0f, 1.0f, 1.7f}));
  }
  return mesh;
}

// The lantern hangs below the origin, its foot at y = -0.75.
Mesh lantern_frame() {
  Profile cap({0.20f, -0.26f});
  cap.line_to({0.215f, -0.25f})
      .curve_through({{0.14f, -0.17f}, {0.07f, -0.13f}, {0.05f, -0.08f}}, 3)
      .arc_to({0.02f, -0.04f}, 0.5f, 4)
      .line_to({0.012f, 0.0f});
  Mesh mesh = lathe(cap, 14, 0.15f, 0.6f);
  Profile foot({0.001f, -0.75f});
  foot.arc_to({0.03f, -0.70f}, 0.6f, 4)
      .curve_through({{0.06f, -0.66f}, {0.15f, -0.62f}}, 3)
      .line_to({0.17f, -0.60f})
      .line_to({0.16f, -0.595f})
      .line_to({0.02f, -0.595f});
  mesh.append(lathe(foot, 14, 0.12f, 0.6f));
  Profile under({0.02f, -0.262f});
  under.line_to({0.20f, -0.262f});
  mesh.append(lathe(under, 14, 0.15f, 0.6f));
  const Mesh post = rod(0.009f, 0.35f, 6);
  for (int i = 0; i < 6; ++i) {
    const float angle = pi / 3.0f * float(i);
    const glm::mat4 place = moved({0.158f * std::cos(angle), -0.60f, -0.158f * std::sin(angle)});
    const glm::mat4 lean(glm::vec4(1, 0, 0, 0),
                         glm::vec4(0.1f * std::cos(angle), 1, -0.1f * std::sin(angle), 0),
                         glm::vec4(0, 0, 1, 0), glm::vec4(0, 0, 0, 1));
    mesh.append(post, place * lean);
  }
  return mesh;
}

Mesh lantern_glass() {
  Profile profile({0.03f, -0.59f});
  profile.curve_through({{0.10f, -0.56f}, {0.135f, -0.44f}, {0.12f, -0.33f}, {0.07f, -0.27f}}, 3);
  return lathe(profile, 14, 0.12f, 0.6f);
}

}  // namespace

void add_lanterns(Document& document, const AtriumMaterials& m) {
  constexpr float chain_length = 1.35f;
  const float hook = plan::lower.springing + plan::lower.arch_radius - 0.02f;
  const int links = document.add_mesh("lantern_chain", chain(chain_length), m.iron);
  const int frame = document.add_mesh("lantern_frame", lantern_frame(), m.bronze);
  const int glass = document.add_mesh("lantern_glass", lantern_glass(), m.lantern_glass);
  const std::vector<plan::Spot> bays = plan::bays();
  for (const int bay : {1, 3, 4, 6, 9, 11, 12, 14, 17, 20}) {
    const plan::Spot& spot = bays[std::size_t(bay)];
    const float arch =
        plan::arch_radius(plan::lower, spot.on_long_side ? plan::bay : plan::short_bay);
    const float top = hook + arch - plan::lower.arch_radius;
    document.place(links, spot.at(top));
    document.place(frame, spot.at(top - chain_length));
    document.place(glass, spot.at(top - chain_length));
    Light light;
    light.name = "lantern_light";
    light.color = {1.0f, 0.62f, 0.30f};
    light.intensity = 2.2f;
    light.range = 9.0f;
    Node node;
    // Below the frame, which would shadow the room from a light inside it.
    node.translation = spot.at(top - chain_length - 0.85f);
    document.add_light(std::move(light), std::move(node));
  }
}

namespace {

constexpr float banner_width = 0.95f;
constexpr float banner_length = 2.5f;
constexpr float pole_length = 1.45f;
constexpr float pole_rise = 0.30f;  // over its length

// A gonfalon with a swallow tail that hangs from a pole along +Z, in the plane x = 0, stirred by a
// light wind that grows towards its foot.
Mesh banner_cloth(double phase) {
  return smooth_patch(14, 26, {banner_width, banner_length}, [=](double u, double v) {
    const double tail = 0.32 * std::abs(2.0 * u - 1.0) - 0.16;
    const double drop = v * (banner_length + tail * v * v);
    const double wave = 0.055 * std::sin(period * (1.15 * u - 0.55 * v) + phase) +
                        0.035 * std::sin(period * (2.3 * u + 0.7 * v) + 2.0 * phase);
    const double along = 0.38 + u * banner_width;
    return glm::dvec3(wave * (0.12 + v * 0.88), pole_rise * along / pole_length - drop, along);
  });
}

Mesh banner_pole() {
  const float length = std::hypot(pole_length, pole_rise);
  Mesh mesh = rod(0.024f, length, 10);
  mesh.append(sphere(0.05f, 14, 8, {0.3f, 0.15f}), moved({0.0f, length + 0.03f, 0.0f}));
  Mesh out;
  out.append(mesh, turned(0.5f * pi - std::atan2(pole_rise, pole_length), {1, 0, 0}));
  return out;
}

// Both halves of a curtain in an arch of the lower arcade, tied back to the columns. The origin is
// on the rod, so that the clips can swing it.
Mesh curtain_pair() {
  constexpr double height = 3.75;
  constexpr double half_opening = 1.36;
  Mesh mesh;
  for (const double side : {-1.0, 1.0}) {
    mesh.append(smooth_patch(38, 11, {2.6f, float(height)}, [=](double u, double v) {
      // Width of the gathered cloth: wide on the rod, narrow at the tie, wider on the floor.
      const double to_tie = std::min(v / 0.56, 1.0);
      const double below = std::max(0.0, (v - 0.56) / 0.44);
      const double width =
          1.28 - 1.0 * to_tie * to_tie * (3.0 - 2.0 * to_tie) + 0.30 * below * (2.0 - below);
      const double depth = 0.055 + 0.045 * (1.28 - width);
      const double folds = std::cos(period * (4.6 * u + 0.3 * std::sin(3.0 * v)));
      const double sag = 0.10 * std::sin(period * 0.5 * u) * to_tie;
      return glm::dvec3(side * (half_opening - width * u), -height * v - sag,
                        depth * folds + 0.02 * std::sin(period * 3.0 * u + 5.0 * v));
    }));
  }
  return mesh;
}

Mesh curtain_rod() {
  Mesh mesh;
  mesh.append(rod(0.022f, 2.9f, 10), moved({1.45f, 3.80f, 0.0f}) * turned(0.5f * pi, {0, 0, 1}));
  for (const float x : {-1.28f, 1.28f}) {
    mesh.append(torus(0.15f, 0.022f, 14, 6),
                glm::scale(moved({x, 1.66f, 0.0f}), {1.0f, 2.2f, 0.75f}));
  }
  return mesh;
}

}  // namespace

void add_cloths(Document& document, const AtriumMaterials& m) {
  std::array<int, 3> cloth{};
  for (std::size_t i = 0; i < 3; ++i) {
    cloth[i] = document.add_mesh(document.materials[std::size_t(m.banners[i])].name,
                                 banner_cloth(1.7 * double(i)), m.banners[i]);
  }
  const int pole = document.add_mesh("banner_pole", banner_pole(), m.gold);
  const std::vector<plan::Spot> columns = plan::columns();
  constexpr float height = 9.55f;
  std::size_t color = 0;
  for (const int column : {1, 3, 5, 7, 10, 12, 14, 16}) {
    const plan::Spot& spot = columns[std::size_t(column)];
    const float inwards = spot.position.y < 0.0f ? 0.20f : -0.20f;
    const glm::vec3 foot = spot.at(height) + glm::vec3(0.0f, 0.0f, inwards);
    document.place(pole, foot, spot.turn);
    document.place(cloth[color++ % 3], foot, spot.turn);
  }
  const int curtain = document.add_mesh("curtain", curtain_pair(), m.curtain);
  const int rods = document.add_mesh("curtain_rod", curtain_rod(), m.bronze);
  const std::vector<plan::Spot> bays = plan::bays();
  for (const int bay : {2, 5, 10, 13}) {
    const plan::Spot& spot = bays[std::size_t(bay)];
    document.place(curtain, spot.at(3.76f), spot.turn);
    document.place(rods, spot.at(0.0f), spot.turn);
  }
}

}  // namespace heliograph::scenes
