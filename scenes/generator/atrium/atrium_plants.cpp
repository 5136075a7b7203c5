#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "scenes/generator/atrium/atrium_parts.hpp"
#include "scenes/generator/atrium/atrium_plan.hpp"
#include "scenes/generator/geometry/shapes.hpp"
#include "scenes/generator/geometry/transforms.hpp"
#include "scenes/generator/textures/noise.hpp"

namespace heliograph::scenes {
namespace {

Mesh urn() {
  Profile profile({0.20f, 0.0f});
  profile.line_to({0.20f, 0.04f})
      .arc_by({-0.05f, 0.05f}, -0.6f, 3)
      .line_by({0.0f, 0.02f})
      .curve_through(
          {{0.24f, 0.24f}, {0.33f, 0.46f}, {0.31f, 0.66f}, {0.21f, 0.82f}, {0.19f, 0.90f}}, 2)
      .curve_through({{0.22f, 0.96f}, {0.28f, 1.00f}}, 3)
      .arc_by({-0.02f, 0.02f}, 0.9f, 2)
      .line_to({0.20f, 0.95f})
      .line_to({0.17f, 0.90f});
  Mesh mesh = lathe(profile, 24, 0.28f, 1.2f);
  const Mesh handle = patch(9, 5, [](float u, float v) {
    const float around = pi * (1.5f - 1.15f * u);
    const float tube = 2.0f * pi * (v < 1.0f ? v : 0.0f);
    const glm::vec3 spoke(-std::cos(around), -std::sin(around), 0.0f);
    const glm::vec3 normal = spoke * std::cos(tube) + glm::vec3(0, 0, std::sin(tube));
    return SurfacePoint{glm::vec3(0.27f, 0.76f, 0.0f) + 0.13f * spoke + 0.022f * normal,
                        normal,
                        {0.4f * u, 0.14f * v}};
  });
  mesh.append(handle);
  mesh.append(handle, turned(pi, {0, 1, 0}));
  return mesh;
}

Mesh garden_pot() {
  Profile profile({0.24f, 0.0f});
  profile.line_to({0.25f, 0.05f})
      .line_to({0.235f, 0.06f})
      .curve_through({{0.32f, 0.34f}, {0.36f, 0.52f}}, 4)
      .line_by({0.02f, 0.0f})
      .arc_by({0.0f, 0.07f}, 0.5f, 4)
      .line_by({-0.02f, 0.0f})
      .line_by({0.0f, 0.03f})
      .arc_by({-0.04f, 0.0f}, 0.9f, 4)
      .line_to({0.31f, 0.54f});
  return lathe(profile, 26, 0.32f, 1.0f);
}

// One leaf blade that arches outwards and down, creased along the middle; u across, v from the
// stalk (bottom of the image) to the tip.
Mesh blade(float length, float width, float lean, float droop) {
  const auto middle = [=](double t) {
    const double rise = length * (t * std::cos(lean) - droop * t * t * 0.5);
    const double out = length * (t * std::sin(lean) + droop * t * t * 0.22);
    return glm::dvec2(out, rise);
  };
  Mesh mesh = smooth_patch(2, 7, {1.0f, 1.0f}, [=](double u, double v) {
    const double t = 1.0 - v;
    const double across = (u - 0.5) * width;
    const glm::dvec2 spine = middle(t);
    return glm::dvec3(across, spine.y + 0.35 * across * across / width, spine.x);
  });
  for (Vertex& vertex : mesh.vertices) {
    if (vertex.normal.y < 0.0f) vertex.normal = -vertex.normal;
  }
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const auto at = [&](std::size_t k) { return mesh.vertices[mesh.indices[i + k]]; };
    const glm::vec3 facing =
        glm::cross(at(1).position - at(0).position, at(2).position - at(0).position);
    if (glm::dot(facing, at(0).normal + at(1).normal + at(2).normal) < 0.0f) {
      std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
    }
  }
  return mesh;
}

// A rosette of blades round the origin, young and upright in the middle, old and bent outside.
Mesh plant(int blades, float size, std::uint32_t seed) {
  Mesh mesh;
  for (int i = 0; i < blades; ++i) {
    const auto random = [&](int what) { return hash_unit(i, what, seed); };
    const float age = (float(i) + 0.5f) / float(blades);
    const float length = size * (0.75f + 0.35f * random(0)) * (1.0f - 0.15f * age);
    const float lean = 0.08f + 0.85f * age + 0.12f * random(1);
    const float droop = 0.25f + 0.75f * age * (0.7f + 0.6f * random(2));
    const float turn = float(i) * 2.39996f + 0.4f * random(3);  // golden angle
    mesh.append(blade(length, 0.17f * size, lean, droop), turned(turn, {0, 1, 0}));
  }
  return mesh;
}

// The way of a strand of ivy in (z, y): over the rail of the balustrade, down to the ledge of the
// cornice, across it, and freely down before the arches.
glm::vec2 along_strand(float distance) {
  static const std::vector<glm::vec2> way = {{-0.05f, 0.98f}, {0.20f, 0.93f}, {0.30f, 0.45f},
                                             {0.52f, 0.10f},  {0.77f, 0.05f}, {0.80f, -3.0f}};
  for (std::size_t i = 0; i + 1 < way.size(); ++i) {
    const float length = glm::distance(way[i], way[i + 1]);
    if (distance < length) return glm::mix(way[i], way[i + 1], distance / length);
    distance -= length;
  }
  return way.back();
}

// Ivy with a leaf at every step of its strands. Local origin on the gallery floor, +Z towards the
// courtyard.
Mesh ivy(float width, int strands, std::uint32_t seed) {
  Mesh mesh;
  for (int strand = 0; strand < strands; ++strand) {
    const auto random = [&](int what) { return hash_unit(strand, what, seed); };
    const float start = (random(0) - 0.5f) * width;
    // Longer in the middle of the bay than at its ends.
    const float middle = 1.0f - 2.0f * std::abs(start) / width;
    const float root = 1.3f * random(3);
    const float length = 0.5f + (1.9f * random(1)) * (0.3f + 0.7f * middle);
    constexpr float step = 0.078f;
    for (int i = 0; i < int(length / step); ++i) {
      const float along = root + float(i) * step;
      const auto leaf_random = [&](int what) {
        return hash_unit(strand * 64 + i, what, seed + 1) - 0.5f;
      };
      const float sway = 0.10f * std::sin(5.0f * along + 6.0f * random(2));
      const glm::vec2 path = along_strand(along);
      const glm::vec3 place(start + sway + 0.08f * leaf_random(0), path.y,
                            path.x + 0.02f + 0.06f * leaf_random(1));
      const float size = 0.17f + 0.07f * leaf_random(2);
      Mesh leaf = quad({-0.42f * size, 0, 0}, {0.42f * size, 0, 0}, {0.42f * size, size, 0},
                       {-0.42f * size, size, 0});
      leaf.vertices[0].uv = {0, 1};
      leaf.vertices[1].uv = {1, 1};
      leaf.vertices[2].uv = {1, 0};
      leaf.vertices[3].uv = {0, 0};
      // Hanging, turned aside and lifted from the wall.
      const glm::mat4 pose = moved(place) * turned(1.6f * leaf_random(3), {0, 1, 0}) *
                             turned(-2.3f + 0.9f * leaf_random(4), {1, 0, 0}) *
                             turned(1.3f * leaf_random(5), {0, 0, 1});
      // Seen from the court they show their upper side.
      mesh.append(leaf, pose * turned(pi, {0, 1, 0}));
    }
  }
  return mesh;
}

}  // namespace

void add_plants(Document& document, const AtriumMaterials& m) {
  const int urns = document.add_mesh("urn", urn(), m.majolica);
  const int pots = document.add_mesh("garden_pot", garden_pot(), m.pot);
  const int tall = document.add_mesh("urn_plant", plant(26, 0.95f, 71), m.leaf);
  const int wide = document.add_mesh("pot_plant", plant(34, 1.15f, 72), m.leaf);
  Mesh earth;
  const std::vector<plan::Spot> columns = plan::columns();
  for (const int column : {1, 3, 5, 7, 10, 12, 14, 16}) {
    const plan::Spot& spot = columns[std::size_t(column)];
    const float inwards = spot.position.y < 0.0f ? 0.95f : -0.95f;
    const glm::vec3 foot = spot.at(0.0f) + glm::vec3(0.0f, 0.0f, inwards);
    document.place(urns, foot, spot.turn);
    document.place(tall, foot + glm::vec3(0.0f, 0.90f, 0.0f), 47.0f * float(column));
  }
  for (const float x : {-3.55f, 3.55f}) {
    for (const float z : {-2.55f, 2.55f}) {
      document.place(pots, {x, 0.0f, z}, 20.0f * x);
      document.place(wide, {x, 0.56f, z}, 30.0f * (x + 2.0f * z));
      earth.append(disc(0.33f, 20), moved({x, 0.57f, z}));
    }
  }
  // One bay on either side of the court.
  const int green = document.add_mesh("ivy", ivy(plan::bay - 0.9f, 44, 73), m.leaf);
  const std::vector<plan::Spot> bays = plan::bays();
  for (const int bay : {4, 11}) {
    document.place(green, bays[std::size_t(bay)].at(plan::upper.floor),
                   bays[std::size_t(bay)].turn);
  }
  document.place(document.add_mesh("pot_soil", std::move(earth), m.soil), {});
}

}  // namespace heliograph::scenes
