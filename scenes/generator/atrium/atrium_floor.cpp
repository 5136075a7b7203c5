#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <vector>

#include "scenes/generator/atrium/atrium_parts.hpp"
#include "scenes/generator/atrium/atrium_plan.hpp"
#include "scenes/generator/geometry/shapes.hpp"
#include "scenes/generator/textures/noise.hpp"

namespace heliograph::scenes {
namespace {

constexpr float joint = 0.004f;  // half the gap between two slabs
constexpr float bevel = 0.006f;

constexpr glm::vec2 field{15.0f, 4.0f};        // half extents of the octagon pavement of the nave
constexpr glm::vec2 pool_opening{3.0f, 2.0f};  // left out of it

// A convex outline, counter-clockwise in (x, z), with every edge moved inwards by `distance`.
std::vector<glm::vec2> inset(const std::vector<glm::vec2>& outline, float distance) {
  const std::size_t count = outline.size();
  const auto inward = [&](std::size_t i) {
    const glm::vec2 edge = glm::normalize(outline[(i + 1) % count] - outline[i]);
    return glm::vec2(-edge.y, edge.x);
  };
  std::vector<glm::vec2> result;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::vec2 before = inward((i + count - 1) % count);
    const glm::vec2 after = inward(i);
    result.push_back(outline[i] + distance * (before + after) / (1.0f + glm::dot(before, after)));
  }
  return result;
}

// A slab with chamfered edges whose top lies near y = 0, laid by hand: each a little higher or
// lower and out of level, and cut from another part of the marble.
void lay_slab(Mesh& mesh, const std::vector<glm::vec2>& outline) {
  glm::vec2 middle(0.0f);
  for (const glm::vec2& corner : outline) middle += corner / float(outline.size());
  const int cell_x = int(std::lround(middle.x * 100.0f));
  const int cell_z = int(std::lround(middle.y * 100.0f));
  const auto random = [&](std::uint32_t seed) { return hash_unit(cell_x, cell_z, seed) - 0.5f; };
  const glm::vec2 tilt = 0.0030f * glm::vec2(random(1), random(2));
  const float lift = 0.0016f * random(3);
  const glm::vec2 cut = 7.0f * glm::vec2(random(4), random(5));
  const int quarter_turns = int(hash(cell_x, cell_z, 6) % 4u);
  const auto uv = [&](glm::vec2 p) {
    glm::vec2 q = p - middle;
    for (int i = 0; i < quarter_turns; ++i) q = {-q.y, q.x};
    return q + cut;
  };
  const auto height = [&](glm::vec2 p) { return lift + glm::dot(tilt, p - middle); };
  const glm::vec3 up = glm::normalize(glm::vec3(-tilt.x, 1.0f, -tilt.y));

  const std::vector<glm::vec2> rim = inset(outline, joint);
  const std::vector<glm::vec2> face = inset(outline, joint + bevel);
  const auto top = static_cast<std::uint32_t>(mesh.vertices.size());
  const auto count = static_cast<std::uint32_t>(outline.size());
  for (const glm::vec2& p : face) {
    mesh.vertices.push_back({{p.x, height(p), p.y}, up, {}, uv(p)});
  }
  for (std::uint32_t i = 1; i + 1 < count; ++i) mesh.add_triangle(top, top + i, top + i + 1);
  for (std::uint32_t i = 0; i < count; ++i) {
    const glm::vec2 edge = glm::normalize(outline[(i + 1) % count] - outline[i]);
    const glm::vec3 normal = glm::normalize(glm::vec3(edge.y, 1.0f, -edge.x));
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const std::uint32_t corner : {i, (i + 1) % count}) {
      const glm::vec2 in = face[corner];
      const glm::vec2 out = rim[corner];
      mesh.vertices.push_back({{in.x, height(in), in.y}, normal, {}, uv(in)});
      mesh.vertices.push_back({{out.x, height(in) - bevel, out.y}, normal, {}, uv(out)});
    }
    mesh.add_triangle(first, first + 2, first + 3);
    mesh.add_triangle(first, first + 3, first + 1);
  }
}

void lay_rectangle(Mesh& mesh, glm::vec2 low, glm::vec2 high) {
  lay_slab(mesh, {{low.x, low.y}, {high.x, low.y}, {high.x, high.y}, {low.x, high.y}});
}

// Rows of rectangles that fill an area.
void lay_rows(Mesh& mesh, glm::vec2 low, glm::vec2 high, glm::vec2 wanted) {
  const glm::ivec2 count = glm::max(glm::ivec2(glm::round((high - low) / wanted)), glm::ivec2(1));
  const glm::vec2 size = (high - low) / glm::vec2(count);
  for (int z = 0; z < count.y; ++z) {
    for (int x = 0; x < count.x; ++x) {
      const glm::vec2 corner = low + size * glm::vec2(x, z);
      lay_rectangle(mesh, corner, corner + size);
    }
  }
}

// A rectangular ring between two half extents.
void lay_ring(Mesh& mesh, glm::vec2 inner, glm::vec2 outer, glm::vec2 wanted) {
  const glm::vec2 turned(wanted.y, wanted.x);
  lay_rows(mesh, {-outer.x, -outer.y}, {outer.x, -inner.y}, wanted);
  lay_rows(mesh, {-outer.x, inner.y}, {outer.x, outer.y}, wanted);
  lay_rows(mesh, {-outer.x, -inner.y}, {-inner.x, inner.y}, turned);
  lay_rows(mesh, {inner.x, -inner.y}, {outer.x, inner.y}, turned);
}

struct Pavement {
  Mesh light, dark, red;
};

// Octagons of one metre with dark diamonds set between them, and a red one at every third.
void lay_octagons(Pavement& pavement) {
  constexpr float cut = 0.24f;  // of the corners
  for (int z = 0; z < int(2.0f * field.y); ++z) {
    for (int x = 0; x < int(2.0f * field.x); ++x) {
      const glm::vec2 c = glm::vec2(x, z) + 0.5f - field;
      if (std::abs(c.x) < pool_opening.x && std::abs(c.y) < pool_opening.y) continue;
      const float h = 0.5f;
      lay_slab(pavement.light,
               {c + glm::vec2(-h + cut, -h), c + glm::vec2(h - cut, -h), c + glm::vec2(h, -h + cut),
                c + glm::vec2(h, h - cut), c + glm::vec2(h - cut, h), c + glm::vec2(-h + cut, h),
                c + glm::vec2(-h, h - cut), c + glm::vec2(-h, -h + cut)});
    }
  }
  for (int z = 0; z <= int(2.0f * field.y); ++z) {
    for (int x = 0; x <= int(2.0f * field.x); ++x) {
      const glm::vec2 c = glm::vec2(x, z) - field;
      if (std::abs(c.x) < pool_opening.x && std::abs(c.y) < pool_opening.y) continue;
      // Half a diamond is left where the field ends.
      const glm::vec2 low = glm::max(c - cut, -field) - c;
      const glm::vec2 high = glm::min(c + cut, field) - c;
      std::vector<glm::vec2> outline;
      for (const glm::vec2 tip :
           {glm::vec2(0, low.y), glm::vec2(high.x, 0), glm::vec2(0, high.y), glm::vec2(low.x, 0)}) {
        if (outline.empty() || glm::distance(outline.back(), c + tip) > 0.01f) {
          outline.push_back(c + tip);
        }
      }
      if (outline.size() > 1 && glm::distance(outline.front(), outline.back()) < 0.01f) {
        outline.pop_back();
      }
      if (outline.size() >= 3) {
        lay_slab((x + z) % 3 == 0 ? pavement.red : pavement.dark, outline);
      }
    }
  }
}

// The aisles: squares of two marbles, alternating.
void lay_checkers(Pavement& pavement, glm::vec2 inner) {
  constexpr float size = 0.8f;
  const glm::ivec2 count(glm::round(2.0f * plan::walls / size));
  const glm::vec2 step = 2.0f * plan::walls / glm::vec2(count);
  for (int z = 0; z < count.y; ++z) {
    for (int x = 0; x < count.x; ++x) {
      const glm::vec2 low = step * glm::vec2(x, z) - plan::walls;
      const glm::vec2 high = low + step;
      const glm::vec2 nearest = glm::max(low, -high);  // distance of the near edge from the axis
      if (nearest.x < inner.x - 0.01f && nearest.y < inner.y - 0.01f) continue;
      lay_rectangle((x + z) % 2 == 0 ? pavement.light : pavement.red, low, high);
    }
  }
}

}  // namespace

void add_floors(Document& document, const AtriumMaterials& m) {
  Pavement pavement;
  lay_octagons(pavement);
  const glm::vec2 first_band = field + 0.3f;
  const glm::vec2 walk = plan::walls - glm::vec2(3.2f, 4.0f);  // a whole number of aisle squares
  lay_ring(pavement.dark, field, first_band, {1.2f, 0.3f});
  lay_ring(pavement.light, first_band, walk - 0.25f, {1.6f, 1.4f});
  lay_ring(pavement.dark, walk - 0.25f, walk, {1.2f, 0.25f});
  lay_checkers(pavement, walk);

  document.place(document.add_mesh("floor_light", std::move(pavement.light), m.floor_light), {});
  document.place(document.add_mesh("floor_dark", std::move(pavement.dark), m.floor_dark), {});
  document.place(document.add_mesh("floor_red", std::move(pavement.red), m.floor_red), {});
  // Seen only in the joints; the opening of the pool stays free.
  Mesh bed;
  const float y = -bevel - 0.004f;
  const auto strip = [&](glm::vec2 low, glm::vec2 high) {
    bed.append(quad_facing({low.x, y, high.y}, {high.x, y, high.y}, {high.x, y, low.y},
                           {low.x, y, low.y}, {0, 1, 0}));
  };
  strip(-plan::walls, {plan::walls.x, -pool_opening.y});
  strip({-plan::walls.x, pool_opening.y}, plan::walls);
  strip({-plan::walls.x, -pool_opening.y}, {-pool_opening.x, pool_opening.y});
  strip({pool_opening.x, -pool_opening.y}, {plan::walls.x, pool_opening.y});
  document.place(document.add_mesh("mortar_bed", std::move(bed), m.mortar), {});
}

void add_pool(Document& document, const AtriumMaterials& m) {
  const glm::vec2 inner = pool_opening - 0.5f;
  constexpr float rim_top = 0.32f;
  constexpr float water_level = 0.20f;
  Profile rim({0.56f, -0.01f});
  rim.line_to({0.56f, 0.07f})
      .arc_by({-0.06f, 0.05f}, -0.5f, 4)
      .line_to({0.50f, rim_top - 0.10f})
      .arc_by({0.05f, 0.05f}, 0.4f, 4)
      .line_by({0.0f, 0.03f})
      .arc_to({0.53f, rim_top}, 0.5f, 3)
      .line_to({0.02f, rim_top})
      .arc_to({0.0f, rim_top - 0.02f}, 0.5f, 3);
  document.place(document.add_mesh("pool_rim", rectangular_moulding(rim, inner), m.trim), {});
  Profile wall({0.0f, rim_top - 0.02f});
  wall.line_to({0.0f, water_level - 0.02f});
  document.place(document.add_mesh("pool_wall", rectangular_moulding(wall, inner), m.mosaic), {});
  Mesh water = quad({-inner.x, water_level, inner.y}, {inner.x, water_level, inner.y},
                    {inner.x, water_level, -inner.y}, {-inner.x, water_level, -inner.y});
  document.place(document.add_mesh("water", std::move(water), m.water), {});

  Profile stem({0.42f, 0.15f});
  stem.line_to({0.42f, 0.26f})
      .arc_by({-0.06f, 0.07f}, -0.6f, 5)
      .line_by({-0.05f, 0.0f})
      .curve_through({{0.20f, 0.50f}, {0.15f, 0.75f}, {0.19f, 0.95f}}, 5)
      .arc_by({0.0f, 0.06f}, 0.9f, 5)
      .line_by({0.03f, 0.0f})
      .curve_through({{0.34f, 1.08f}, {0.50f, 1.22f}}, 5)
      .arc_by({-0.01f, 0.06f}, 0.8f, 4)
      .line_to({0.44f, 1.27f})
      .curve_through({{0.30f, 1.16f}, {0.05f, 1.12f}}, 5);
  document.place(document.add_mesh("pedestal", lathe(stem, 30, 0.3f, 1.2f), m.column), {});
  const float radius = 0.46f;
  const int ball = document.add_mesh("hero_sphere", sphere(radius, 64, 32, {3.0f, 1.5f}), m.mirror);
  const int node = document.place(ball, {0.0f, 1.20f + radius, 0.0f});
  document.nodes[std::size_t(node)].name = "hero_sphere";
}

}  // namespace heliograph::scenes
