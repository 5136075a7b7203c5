#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "scenes/generator/atrium/atrium_parts.hpp"
#include "scenes/generator/atrium/atrium_plan.hpp"
#include "scenes/generator/geometry/shapes.hpp"
#include "scenes/generator/geometry/transforms.hpp"

namespace heliograph::scenes {
namespace {

struct ColumnMeasures {
  float pedestal_half;  // of its die
  float pedestal_height;
  float base_height;    // plinth and the two tori of an Attic base
  float bottom_radius;  // of the shaft
  float top_radius;
  float shaft_top;  // above the storey's floor
  float top;
  float abacus_half;
};

constexpr ColumnMeasures lower_column{0.43f, 0.55f, 0.30f, 0.355f, 0.305f, 3.52f, 4.2f, 0.54f};
constexpr ColumnMeasures upper_column{0.27f, 0.95f, 0.20f, 0.200f, 0.170f, 2.98f, 3.4f, 0.36f};

// Closes a square moulding from above or below.
void append_square(Mesh& mesh, float height, float half, bool facing_up) {
  mesh.append(quad_facing({-half, height, half}, {half, height, half}, {half, height, -half},
                          {-half, height, -half}, {0.0f, facing_up ? 1.0f : -1.0f, 0.0f}));
}

Mesh pedestal(const ColumnMeasures& c) {
  const float h = c.pedestal_height;
  Profile profile({0.045f, 0.0f});
  profile.line_to({0.045f, 0.11f})
      .line_by({-0.008f, 0.008f})
      .arc_by({-0.037f, 0.042f}, -0.5f, 4)
      .line_to({0.0f, h - 0.13f})
      .arc_by({0.03f, 0.04f}, -0.5f, 4)
      .line_by({0.0f, 0.012f})
      .arc_by({0.022f, 0.03f}, 0.45f, 3)
      .line_to({0.052f, h - 0.008f})
      .line_to({0.044f, h});
  Mesh mesh = rectangular_moulding(profile, glm::vec2(c.pedestal_half));
  append_square(mesh, h, c.pedestal_half + 0.044f, true);
  return mesh;
}

// Attic base: plinth, torus, scotia between two fillets, smaller torus, apophyge.
Mesh attic_base(const ColumnMeasures& c, int segments) {
  const float r = c.bottom_radius;
  const float unit = c.base_height / 10.0f;
  const float plinth = 3.2f * unit;
  const float spread = 1.36f * r;
  Mesh mesh = bevelled_box({2.0f * spread, plinth, 2.0f * spread}, 0.008f);
  for (Vertex& vertex : mesh.vertices) vertex.position.y += 0.5f * plinth;
  Profile profile({1.18f * r, plinth});
  profile.arc_by({0.0f, 2.6f * unit}, 1.0f, 6)
      .line_by({0.0f, 0.35f * unit})
      .line_to({1.14f * r, profile.pen().y})
      .arc_to({1.08f * r, plinth + 4.6f * unit}, -0.8f, 4)
      .line_by({0.0f, 0.35f * unit})
      .arc_by({0.0f, 1.2f * unit}, 1.0f, 5)
      .line_to({1.05f * r, profile.pen().y})
      .arc_to({r, c.base_height}, -0.3f, 2);
  mesh.append(lathe(profile, segments, 1.2f * r, 1.5f));
  return mesh;
}

Mesh column_foot(const ColumnMeasures& c, int segments) {
  Mesh mesh = pedestal(c);
  mesh.append(attic_base(c, segments),
              glm::translate(glm::mat4(1.0f), {0.0f, c.pedestal_height, 0.0f}));
  return mesh;
}

// The radius of a shaft with entasis: straight below, drawn in above the lower third.
float entasis(const ColumnMeasures& c, float t) {
  const float rise = std::max(0.0f, (t - 0.33f) / 0.67f);
  return glm::mix(c.bottom_radius, c.top_radius, rise * rise * (1.5f - 0.5f * rise));
}

// Cross-section of a fluted shaft of radius 1, going round counter-clockwise seen from above:
// hollows with flat fillets between them (Ionic and Corinthian orders).
Profile fluting(int flutes, int segments) {
  const float sector = 2.0f * pi / float(flutes);
  const auto on_circle = [&](float angle) { return glm::vec2(std::cos(angle), std::sin(angle)); };
  Profile profile(on_circle(0.0f));
  for (int i = 0; i < flutes; ++i) {
    const float start = sector * float(i);
    profile.arc_to(on_circle(start + 0.78f * sector), -0.62f, segments)
        .line_to(on_circle(i + 1 == flutes ? 0.0f : start + sector));
  }
  return profile;
}

Mesh fluted_shaft(const ColumnMeasures& c, int flutes, int rows) {
  const float bottom = c.pedestal_height + c.base_height;
  const float height = c.shaft_top - bottom;
  const Profile section = fluting(flutes, 3);
  const float tile = 1.2f;
  const float repeats = std::round(2.0f * pi * c.bottom_radius / tile);
  const float stretch = std::max(1.0f, repeats) * tile / section.length();
  Mesh mesh;
  for (const auto& run : section.runs()) {
    const int columns = int(run.size()) - 1;
    mesh.append(patch(columns, rows, [&](float u, float v) {
      const ProfilePoint& point = run[std::size_t(std::lround(u * float(columns)))];
      const float radius = entasis(c, v);
      const float slope = (entasis(c, v + 0.01f) - entasis(c, v - 0.01f)) / (0.02f * height);
      const float depth = glm::dot(point.normal, point.position);
      return SurfacePoint{
          {point.position.x * radius, bottom + v * height, -point.position.y * radius},
          {point.normal.x, -slope * depth, -point.normal.y},
          {point.distance * stretch, -v * height}};
    }));
  }
  return mesh;
}

Mesh smooth_shaft(const ColumnMeasures& c, int segments, int rows) {
  const float bottom = c.pedestal_height + c.base_height;
  const float height = c.shaft_top - bottom;
  std::vector<glm::vec2> points;
  for (int i = 1; i <= rows; ++i) {
    const float t = float(i) / float(rows);
    points.push_back({entasis(c, t), bottom + t * height});
  }
  Profile profile({c.bottom_radius, bottom});
  profile.curve_through(points, 1);
  return lathe(profile, segments, c.bottom_radius, 0.9f);
}

// One acanthus leaf: a tongue that climbs the bell and curls outwards, ribbed along the middle.
Mesh acanthus(float foot_radius, float height, float width, float curl) {
  return smooth_patch(4, 5, {width, height}, [=](double u, double v) {
    const double across = 2.0 * u - 1.0;
    const double lobes = 1.0 + 0.10 * std::cos(v * 18.0);
    const double half = 0.5 * width * lobes * std::sqrt(std::max(0.0, 1.02 - v * v * 0.9));
    const double bend = v * v * v;
    const double out = foot_radius + 0.012 + curl * bend - 0.025 * across * across +
                       0.012 * std::cos(across * 7.0) * (1.0 - v);
    const double droop = 0.28 * height * std::pow(std::max(0.0, v - 0.7) / 0.3, 2.0);
    return glm::dvec3(across * half, v * height - droop, out);
  });
}

// A rolled volute as a disc about the Y axis: rim, groove, rim, eye.
Mesh scroll(float radius, float half_width) {
  Profile side({radius * 0.92f, 0.0f});
  side.arc_to({radius * 0.88f, half_width}, 0.3f, 1)
      .line_to({radius * 0.70f, half_width})
      .arc_to({radius * 0.36f, half_width}, -0.6f, 2)
      .arc_to({0.001f, half_width * 1.15f}, 0.3f, 1);
  Mesh mesh = lathe(side, 9, radius, 1.5f);
  mesh.append(Mesh(mesh), glm::rotate(glm::mat4(1.0f), pi, {1.0f, 0.0f, 0.0f}));
  return mesh;
}

// Bell, two rows of eight leaves, corner volutes and a moulded abacus: a plain Corinthian capital.
Mesh leaf_capital(const ColumnMeasures& c) {
  const float height = c.top - c.shaft_top;
  const float r = c.top_radius;
  const float abacus = 0.17f * height;
  const float bell = height - abacus;
  Profile profile({r, 0.0f});
  profile.arc_by({0.0f, 0.06f * height}, 1.0f, 4)
      .curve_through({{r * 0.98f, 0.30f * height},
                      {r * 1.04f, 0.60f * height},
                      {r * 1.30f, bell - 0.03f * height}},
                     2)
      .arc_to({r * 1.30f, bell}, 0.8f, 2);
  Mesh mesh = lathe(profile, 20, r, 1.5f);
  const Mesh low_leaf = acanthus(r, 0.42f * height, 0.72f * r, 0.32f * r);
  const Mesh high_leaf = acanthus(r, 0.72f * height, 0.66f * r, 0.44f * r);
  for (int i = 0; i < 8; ++i) {
    const float turn = 0.25f * pi * float(i);
    mesh.append(low_leaf, glm::rotate(glm::mat4(1.0f), turn, {0.0f, 1.0f, 0.0f}));
    mesh.append(high_leaf, glm::rotate(glm::mat4(1.0f), turn + pi / 8.0f, {0.0f, 1.0f, 0.0f}));
  }
  const Mesh volute = scroll(0.15f * height, 0.045f * height);
  for (int i = 0; i < 4; ++i) {
    // On the diagonals, with the eyes to both sides.
    glm::mat4 place = glm::rotate(glm::mat4(1.0f), pi * (0.5f * float(i) + 0.25f), {0, 1, 0});
    place = glm::translate(place, {0.0f, bell - 0.13f * height, 1.16f * c.abacus_half});
    mesh.append(volute, glm::rotate(place, 0.5f * pi, {0.0f, 0.0f, 1.0f}));
  }
  Profile edge({-0.055f, bell});
  edge.arc_to({-0.03f, bell + 0.45f * abacus}, -0.5f, 3)
      .line_by({0.012f, 0.0f})
      .arc_to({0.0f, height}, 0.5f, 3);
  mesh.append(rectangular_moulding(edge, glm::vec2(c.abacus_half)));
  append_square(mesh, bell, c.abacus_half - 0.055f, false);
  append_square(mesh, height, c.abacus_half, true);
  return mesh;
}

// Tuscan: astragal, necking, echinus with an egg-shaped outline, square abacus.
Mesh plain_capital(const ColumnMeasures& c) {
  const float height = c.top - c.shaft_top;
  const float r = c.top_radius;
  Profile profile({r, 0.0f});
  profile.arc_by({0.0f, 0.10f * height}, 1.0f, 3)
      .line_by({0.0f, 0.26f * height})
      .line_by({0.03f * r, 0.0f})
      .line_by({0.0f, 0.05f * height})
      .curve_through({{1.22f * r, 0.52f * height}, {1.38f * r, 0.68f * height}}, 4);
  Mesh mesh = lathe(profile, 16, r, 1.5f);
  Profile edge({-0.02f, 0.68f * height});
  edge.line_by({0.0f, 0.16f * height})
      .arc_to({0.012f, 0.90f * height}, -0.4f, 3)
      .line_to({0.012f, height});
  mesh.append(rectangular_moulding(edge, glm::vec2(c.abacus_half)));
  append_square(mesh, 0.68f * height, c.abacus_half - 0.02f, false);
  append_square(mesh, height, c.abacus_half + 0.012f, true);
  return mesh;
}

}  // namespace

void add_columns(Document& document, const AtriumMaterials& m) {
  const int lower_foot = document.add_mesh("column_foot", column_foot(lower_column, 20), m.trim);
  const int lower_shaft =
      document.add_mesh("column_shaft", fluted_shaft(lower_column, 20, 5), m.column);
  const int lower_capital =
      document.add_mesh("column_capital", leaf_capital(lower_column), m.capital);
  const int upper_foot =
      document.add_mesh("gallery_column_foot", column_foot(upper_column, 14), m.trim);
  const int upper_shaft =
      document.add_mesh("gallery_column_shaft", smooth_shaft(upper_column, 24, 6), m.column_dark);
  const int upper_capital =
      document.add_mesh("gallery_column_capital", plain_capital(upper_column), m.capital);
  for (const plan::Spot& spot : plan::columns()) {
    document.place(lower_foot, spot.at(plan::lower.floor), spot.turn);
    document.place(lower_shaft, spot.at(plan::lower.floor), spot.turn);
    document.place(lower_capital, spot.at(lower_column.shaft_top), spot.turn);
    document.place(upper_foot, spot.at(plan::upper.floor), spot.turn);
    document.place(upper_shaft, spot.at(plan::upper.floor), spot.turn);
    document.place(upper_capital, spot.at(plan::upper.floor + upper_column.shaft_top), spot.turn);
  }
}

}  // namespace heliograph::scenes
