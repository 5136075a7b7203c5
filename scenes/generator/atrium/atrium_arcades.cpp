#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "scenes/generator/atrium/atrium_parts.hpp"
#include "scenes/generator/atrium/atrium_plan.hpp"
#include "scenes/generator/geometry/shapes.hpp"
#include "scenes/generator/geometry/transforms.hpp"

namespace heliograph::scenes {
namespace {

// The wall of one bay above the springing line, both faces, with a round opening. Local origin: on
// the springing line in the middle of the bay; +Z faces the courtyard.
Mesh arcade_wall(float bay_width, float radius, float height, int segments) {
  const float half = 0.5f * bay_width;
  std::vector<float> xs{-half};
  for (int i = 0; i <= segments; ++i)
    xs.push_back(-radius * std::cos(pi * float(i) / float(segments)));
  xs.push_back(half);
  Mesh mesh;
  for (const float side : {-1.0f, 1.0f}) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const float x : xs) {
      const float inside = radius * radius - x * x;
      const float opening = inside > 1e-6f ? std::sqrt(inside) : 0.0f;
      for (const float y : {opening, height}) {
        mesh.vertices.push_back(
            {{x, y, side * plan::half_wall}, {0.0f, 0.0f, side}, {}, {side * x, -y}});
      }
    }
    for (std::uint32_t i = 0; i + 1 < xs.size(); ++i) {
      const std::uint32_t corner = first + 2 * i;
      mesh.add_triangle(corner, corner + 2, corner + 3);
      mesh.add_triangle(corner, corner + 3, corner + 1);
    }
  }
  Profile soffit({radius, plan::half_wall});
  soffit.line_to({radius, -plan::half_wall});
  mesh.append(sweep(soffit, arch_stations(segments, radius)));
  for (const float side : {-1.0f, 1.0f}) {
    mesh.append(quad_facing({side * radius, 0, -plan::half_wall},
                            {side * half, 0, -plan::half_wall}, {side * half, 0, plan::half_wall},
                            {side * radius, 0, plan::half_wall}, {0, -1, 0}));
  }
  return mesh;
}

// The section of one arch stone, from the courtyard side round the soffit to the aisle side.
// `inset` shrinks it: the joints between stones are grooves.
Profile stone_section(float radius, float depth, float inset) {
  const float inner = radius - 0.03f + inset;
  const float outer = radius + depth - inset;
  const float front = plan::half_wall + 0.035f - inset;
  constexpr float chamfer = 0.014f;
  Profile profile({outer, plan::half_wall - 0.01f});
  profile.line_to({outer, front - chamfer})
      .line_to({outer - chamfer, front})
      .line_to({inner + chamfer, front})
      .line_to({inner, front - chamfer})
      .line_to({inner, chamfer - front})
      .line_to({inner + chamfer, -front})
      .line_to({outer, -front})
      .line_to({outer, 0.01f - plan::half_wall});
  return profile;
}

// Chamfers at one end of a stone, between its section and the inset section in the joint.
Mesh stone_end(float radius, float depth, float groove, float angle, float joint_angle) {
  const Profile face = stone_section(radius, depth, 0.0f);
  const Profile joint = stone_section(radius, depth, groove);
  const auto place = [](glm::vec2 p, float a) {
    return glm::vec3(p.x * std::cos(a), p.x * std::sin(a), p.y);
  };
  Mesh mesh;
  for (std::size_t i = 0; i < face.runs().size(); ++i) {
    const auto& outer = face.runs()[i];
    const auto& inner = joint.runs()[i];
    const glm::vec2 n = outer.front().normal;
    mesh.append(quad_facing(place(outer.front().position, angle),
                            place(outer.back().position, angle),
                            place(inner.back().position, joint_angle),
                            place(inner.front().position, joint_angle), place(n, angle)));
  }
  return mesh;
}

// Every second stone of a round arch, starting with the first or the second.
Mesh voussoirs(float radius, float depth, int stones, int first_stone) {
  constexpr float groove = 0.012f;
  const float sector = pi / float(stones);
  const float margin = groove / radius;
  Mesh mesh;
  for (int stone = first_stone; stone < stones; stone += 2) {
    const float start = sector * float(stone);
    const float end = start + sector;
    mesh.append(sweep(stone_section(radius, depth, 0.0f),
                      arch_stations(2, radius, start + margin, end - margin)));
    mesh.append(stone_end(radius, depth, groove, start + margin, start));
    mesh.append(stone_end(radius, depth, groove, end - margin, end));
  }
  return mesh;
}

// A label moulding that frames the arch stones on the courtyard side.
Mesh hood_mould(float radius, int segments) {
  Profile profile({radius + 0.075f, plan::half_wall - 0.01f});
  profile.line_by({0.0f, 0.055f})
      .arc_by({-0.035f, 0.035f}, 0.5f, 4)
      .line_by({-0.012f, 0.0f})
      .arc_to({radius, plan::half_wall + 0.03f}, -0.5f, 4);
  return sweep(profile, arch_stations(segments, radius));
}

// Three stepped fasciae and a bead round the arch of the gallery, on both faces.
Mesh archivolt(float radius, int segments) {
  const float front = plan::half_wall;
  Profile profile({radius + 0.24f, front - 0.01f});
  profile.line_to({radius + 0.24f, front + 0.06f})
      .arc_by({-0.045f, -0.022f}, 0.5f, 4)
      .line_by({-0.075f, 0.0f})
      .line_by({0.0f, -0.014f})
      .line_by({-0.07f, 0.0f})
      .line_by({0.0f, -0.012f})
      .arc_to({radius - 0.02f, front - 0.02f}, 0.7f, 4)
      .line_to({radius - 0.02f, 0.02f - front})
      .line_to({radius + 0.02f, -front - 0.02f})
      .line_to({radius + 0.16f, -front - 0.02f})
      .line_to({radius + 0.16f, 0.01f - front});
  return sweep(profile, arch_stations(segments, radius));
}

// A wedge with a scroll on its face, at the crown of an arch.
Mesh keystone(float radius, float height) {
  const float lower_half = 0.13f;
  const float upper_half = lower_half * (radius + height) / radius;
  const float bottom = radius - 0.06f;
  const float top = radius + height;
  Profile side({plan::half_wall - 0.02f, bottom});
  side.line_to({plan::half_wall + 0.07f, bottom})
      .arc_by({0.0f, 0.10f}, 0.9f, 6)
      .curve_through({{plan::half_wall + 0.10f, bottom + 0.45f * (top - bottom)},
                      {plan::half_wall + 0.16f, top - 0.05f}},
                     5)
      .line_to({plan::half_wall + 0.16f, top})
      .line_to({plan::half_wall - 0.02f, top});
  const auto half_at = [&](float y) {
    return glm::mix(lower_half, upper_half, (y - bottom) / (top - bottom));
  };
  Mesh mesh;
  for (const auto& run : side.runs()) {
    const int rows = int(run.size()) - 1;
    mesh.append(patch(1, rows, [&](float u, float v) {
      const ProfilePoint& p = run[std::size_t(std::lround(v * float(rows)))];
      const float x = (2.0f * u - 1.0f) * half_at(p.position.y);
      return SurfacePoint{
          {x, p.position.y, p.position.x}, {0.0f, p.normal.y, p.normal.x}, {x, -p.distance}};
    }));
    for (const float end : {-1.0f, 1.0f}) {
      mesh.append(patch(1, rows, [&](float u, float v) {
        const ProfilePoint& p = run[std::size_t(std::lround(v * float(rows)))];
        const float z = glm::mix(plan::half_wall - 0.02f, p.position.x, u);
        return SurfacePoint{{end * half_at(p.position.y), p.position.y, z},
                            {end, 0.0f, 0.0f},
                            {end * z, -p.position.y}};
      }));
    }
  }
  return mesh;
}

struct ArchMeshes {
  int wall, light_trim, red_stones;  // -1 where there is none
};

ArchMeshes lower_arch(Document& document, const AtriumMaterials& m, const std::string& prefix,
                      float bay_width) {
  const float radius = plan::arch_radius(plan::lower, bay_width);
  const int stones = bay_width > 3.5f ? 17 : 13;
  const float height = plan::lower.wall_top - plan::lower.springing;
  constexpr float depth = 0.36f;
  Mesh light = voussoirs(radius, depth, stones, 0);
  light.append(hood_mould(radius + depth, 20));
  return {
      document.add_mesh(prefix + "_wall", arcade_wall(bay_width, radius, height, 24), m.ashlar),
      document.add_mesh(prefix + "_stones_light", std::move(light), m.trim),
      document.add_mesh(prefix + "_stones_red", voussoirs(radius, depth, stones, 1), m.trim_red)};
}

ArchMeshes upper_arch(Document& document, const AtriumMaterials& m, const std::string& prefix,
                      float bay_width) {
  const float radius = plan::arch_radius(plan::upper, bay_width);
  const float height = plan::upper.wall_top - plan::upper.springing;
  Mesh trim = archivolt(radius, 16);
  trim.append(keystone(radius, 0.32f));
  return {document.add_mesh(prefix + "_wall", arcade_wall(bay_width, radius, height, 22), m.ashlar),
          document.add_mesh(prefix + "_archivolt", std::move(trim), m.trim), -1};
}

void place_arch(Document& document, const ArchMeshes& arch, glm::vec3 origin, float turn) {
  for (const int mesh : {arch.wall, arch.light_trim, arch.red_stones}) {
    if (mesh >= 0) document.place(mesh, origin, turn);
  }
}

void add_corner_piers(Document& document, const AtriumMaterials& m) {
  // A little wider than the walls that meet here, so that no two faces coincide.
  const float width = plan::wall_thickness + 0.04f;
  Mesh piers;
  for (const plan::Storey& storey : {plan::lower, plan::upper}) {
    const float height = storey.wall_top - storey.springing;
    const Mesh pier = box({width, height, width});
    for (const float x : {-plan::arcade.x, plan::arcade.x}) {
      for (const float z : {-plan::arcade.y, plan::arcade.y}) {
        piers.append(pier,
                     glm::translate(glm::mat4(1.0f), {x, storey.springing + 0.5f * height, z}));
      }
    }
  }
  document.place(document.add_mesh("corner_piers", std::move(piers), m.ashlar), {});
}

}  // namespace

void add_arcades(Document& document, const AtriumMaterials& m) {
  const ArchMeshes lower_long = lower_arch(document, m, "arch", plan::bay);
  const ArchMeshes lower_short = lower_arch(document, m, "end_arch", plan::short_bay);
  const ArchMeshes upper_long = upper_arch(document, m, "gallery_arch", plan::bay);
  const ArchMeshes upper_short = upper_arch(document, m, "gallery_end_arch", plan::short_bay);
  for (const plan::Spot& spot : plan::bays()) {
    place_arch(document, spot.on_long_side ? lower_long : lower_short,
               spot.at(plan::lower.springing), spot.turn);
    place_arch(document, spot.on_long_side ? upper_long : upper_short,
               spot.at(plan::upper.springing), spot.turn);
  }
  add_corner_piers(document, m);
}

namespace {

// Architrave, frieze band left flat for the painted strip, dentils, corona and cyma.
Profile cornice_profile(float height, float projection) {
  Profile profile({-0.05f, 0.0f});
  profile.line_to({0.035f, 0.0f})
      .line_to({0.035f, 0.22f * height})
      .arc_by({0.05f, 0.06f * height}, -0.5f, 3)
      .line_by({0.0f, 0.22f * height})
      .line_to({0.55f * projection, 0.5f * height})
      .line_by({0.0f, 0.02f * height})
      .line_to({0.72f * projection, 0.53f * height})
      .line_by({0.0f, 0.17f * height})
      .line_by({0.015f, 0.0f})
      .curve_through({{0.80f * projection, 0.78f * height},
                      {0.93f * projection, 0.88f * height},
                      {projection, 0.95f * height}},
                     3)
      .line_to({projection, height})
      .line_to({-0.05f, height});
  return profile;
}

Mesh cornice(float length, float height, float projection) {
  Mesh mesh = sweep(cornice_profile(height, projection), straight_stations(length));
  const Mesh dentil = box({0.10f, 0.18f * height, 0.55f * projection - 0.08f});
  const int count = int(length / 0.21f);
  for (int i = 0; i < count; ++i) {
    const float x = (float(i) + 0.5f - 0.5f * float(count)) * length / float(count);
    mesh.append(dentil,
                glm::translate(glm::mat4(1.0f), {x, 0.40f * height, 0.04f + 0.275f * projection}));
  }
  return mesh;
}

Mesh frieze(float length, float height) {
  const float half = 0.5f * length;
  return quad({-half, 0, 0}, {half, 0, 0}, {half, height, 0}, {-half, height, 0});
}

void add_cornice_ring(Document& document, const AtriumMaterials& m, const plan::Storey& storey,
                      const std::string& prefix, float projection) {
  const float height = storey.top - storey.wall_top;
  const glm::vec2 length = 2.0f * (plan::arcade - plan::half_wall);
  const int long_side = document.add_mesh(prefix, cornice(length.x, height, projection), m.trim);
  const int short_side =
      document.add_mesh(prefix + "_end", cornice(length.y, height, projection), m.trim);
  for (const plan::Spot& side : plan::sides(-plan::half_wall)) {
    document.place(side.on_long_side ? long_side : short_side, side.at(storey.wall_top), side.turn);
  }
}

}  // namespace

void add_cornices(Document& document, const AtriumMaterials& m) {
  add_cornice_ring(document, m, plan::lower, "cornice", 0.36f);
  add_cornice_ring(document, m, plan::upper, "eaves_cornice", 0.46f);
  // The painted band runs over the crowns of the upper arches, a hair before the wall.
  constexpr float band = 0.30f;
  const glm::vec2 length = 2.0f * (plan::arcade - plan::half_wall);
  const int long_side = document.add_mesh("frieze", frieze(length.x, band), m.frieze);
  const int short_side = document.add_mesh("frieze_end", frieze(length.y, band), m.frieze);
  for (const plan::Spot& side : plan::sides(-plan::half_wall - 0.012f)) {
    document.place(side.on_long_side ? long_side : short_side, side.at(plan::upper.wall_top - band),
                   side.turn);
  }
}

namespace {

constexpr float rail_height = 0.95f;
constexpr float pedestal_clearance = 0.31f;  // from the column axis to the end of the rail

Mesh baluster() {
  Profile profile({0.062f, 0.0f});
  profile.line_by({0.0f, 0.05f})
      .line_to({0.045f, 0.06f})
      .curve_through(
          {{0.040f, 0.10f}, {0.066f, 0.21f}, {0.055f, 0.33f}, {0.034f, 0.46f}, {0.030f, 0.56f}}, 1)
      .arc_by({0.0f, 0.03f}, 0.8f, 2)
      .line_to({0.055f, 0.62f})
      .line_to({0.055f, 0.70f});
  return lathe(profile, 8, 0.06f, 1.5f);
}

Mesh baluster_row(float length) {
  const int count = int(length / 0.31f);
  const Mesh one = baluster();
  Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const float x = (float(i) + 0.5f - 0.5f * float(count)) * length / float(count);
    mesh.append(one, glm::translate(glm::mat4(1.0f), {x, 0.10f, 0.0f}));
  }
  return mesh;
}

Mesh balustrade(float length) {
  Mesh mesh = baluster_row(length);
  mesh.append(bevelled_box({length, 0.10f, 0.30f}, 0.01f),
              glm::translate(glm::mat4(1.0f), {0.0f, 0.05f, 0.0f}));
  Profile profile({0.09f, 0.80f});
  profile.line_by({0.0f, 0.03f})
      .arc_by({0.05f, 0.03f}, -0.5f, 3)
      .line_by({0.0f, 0.04f})
      .arc_to({0.08f, rail_height}, 0.4f, 3)
      .line_to({-0.08f, rail_height})
      .arc_by({-0.06f, -0.05f}, 0.4f, 3)
      .line_by({0.0f, -0.04f})
      .arc_to({-0.09f, 0.83f}, -0.5f, 3)
      .line_to({-0.09f, 0.80f})
      .line_to({0.09f, 0.80f});
  mesh.append(sweep(profile, straight_stations(length)));
  return mesh;
}

}  // namespace

void add_balustrades(Document& document, const AtriumMaterials& m) {
  const float long_length = plan::bay - 2.0f * pedestal_clearance;
  const float short_length = plan::short_bay - 2.0f * pedestal_clearance;
  const int long_mesh = document.add_mesh("balustrade", balustrade(long_length), m.capital);
  const int short_mesh = document.add_mesh("balustrade_end", balustrade(short_length), m.capital);
  for (const plan::Spot& spot : plan::bays()) {
    document.place(spot.on_long_side ? long_mesh : short_mesh, spot.at(plan::upper.floor),
                   spot.turn);
  }
}

}  // namespace heliograph::scenes
