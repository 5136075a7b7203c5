#include <functional>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <vector>

#include "scenes/generator/atrium/atrium_parts.hpp"
#include "scenes/generator/atrium/atrium_plan.hpp"
#include "scenes/generator/geometry/shapes.hpp"
#include "scenes/generator/geometry/transforms.hpp"

namespace heliograph::scenes {
namespace {

// A wall of one side from `bottom` to `top`, in the plane z = 0 facing +Z.
Mesh wall_strip(float length, float bottom, float top) {
  const float half = 0.5f * length;
  return quad({-half, bottom, 0}, {half, bottom, 0}, {half, top, 0}, {-half, top, 0});
}

Mesh dado(float length) {
  Profile profile({0.05f, 0.0f});
  profile.line_to({0.05f, 0.16f})
      .arc_by({-0.025f, 0.03f}, -0.5f, 4)
      .line_to({0.025f, 1.20f})
      .arc_by({0.035f, 0.04f}, -0.5f, 4)
      .line_by({0.0f, 0.03f})
      .arc_by({-0.02f, 0.03f}, 0.5f, 3)
      .line_to({0.0f, 1.30f});
  return sweep(profile, straight_stations(length));
}

Mesh impost(float length) {
  const float top = plan::vault_springing;
  Profile profile({0.0f, top - 0.26f});
  profile.arc_by({0.05f, 0.05f}, 0.5f, 4)
      .line_by({0.0f, 0.03f})
      .curve_through({{0.07f, top - 0.12f}, {0.13f, top - 0.06f}}, 3)
      .line_by({0.02f, 0.0f})
      .line_to({0.15f, top})
      .line_to({0.0f, top});
  return sweep(profile, straight_stations(length));
}

// A flat half column on the outer wall that receives a rib, with a moulded foot.
Mesh pilaster(float height) {
  constexpr float half = 0.30f;
  constexpr float depth = 0.16f;
  Profile profile({0.06f, 0.0f});
  profile.line_to({0.06f, 0.20f})
      .arc_by({-0.02f, 0.06f}, 0.9f, 4)
      .line_by({-0.01f, 0.0f})
      .arc_to({0.0f, 0.38f}, -0.4f, 4)
      .line_to({0.0f, height - 0.30f})
      .arc_by({0.0f, 0.05f}, 0.9f, 4)
      .line_to({0.0f, height - 0.16f})
      .arc_by({0.06f, 0.07f}, 0.5f, 4)
      .line_by({0.02f, 0.0f})
      .line_to({0.08f, height});
  return rectangular_moulding(profile, {half, depth});
}

// A field between two pilasters, seen from the front.
struct WallField {
  float middle;
  float half_width;
};
constexpr float field_bottom = 1.58f;
constexpr float field_top = 3.62f;
constexpr float field_height = 0.5f * (field_bottom + field_top);

std::vector<WallField> long_wall_fields() {
  std::vector<WallField> fields;
  for (int i = 0; i < plan::long_bays; ++i) {
    fields.push_back({-plan::arcade.x + plan::bay * (float(i) + 0.5f), 1.26f});
  }
  const float corner = 0.5f * (plan::arcade.x + plan::walls.x);
  fields.push_back({-corner, 1.26f});
  fields.push_back({corner, 1.26f});
  return fields;
}

// The middle bay of the end walls holds a door.
std::vector<WallField> end_wall_fields() {
  const float corner = 0.5f * (plan::arcade.y + plan::walls.y) + 0.1f;
  return {{-plan::short_bay, 0.96f}, {plan::short_bay, 0.96f}, {-corner, 1.7f}, {corner, 1.7f}};
}

Mesh field_frames(const std::vector<WallField>& fields) {
  Mesh mesh;
  for (const WallField& field : fields) {
    Profile profile({0.15f, 0.0f});
    profile.line_by({0.0f, 0.03f})
        .arc_by({-0.04f, 0.03f}, -0.5f, 3)
        .line_by({-0.05f, 0.0f})
        .arc_by({-0.04f, -0.035f}, 0.6f, 3)
        .line_to({0.0f, 0.02f})
        .line_to({0.0f, 0.0f});
    const Mesh frame =
        rectangular_moulding(profile, {field.half_width, 0.5f * (field_top - field_bottom)});
    mesh.append(frame, glm::rotate(moved({field.middle, field_height, 0.0f}), 0.5f * pi,
                                   {1.0f, 0.0f, 0.0f}));
  }
  return mesh;
}

Mesh field_paintings(const std::vector<WallField>& fields) {
  constexpr float off_the_wall = 0.006f;
  Mesh mesh;
  for (const WallField& field : fields) {
    const float left = field.middle - field.half_width;
    const float right = field.middle + field.half_width;
    mesh.append(quad({left, field_bottom, off_the_wall}, {right, field_bottom, off_the_wall},
                     {right, field_top, off_the_wall}, {left, field_top, off_the_wall}));
  }
  return mesh;
}

constexpr float door_half = 0.82f;
constexpr float door_springing = 2.25f;

// Two planked leaves under a round arch, with rails across.
Mesh door_leaves() {
  constexpr int segments = 18;
  constexpr float z = 0.09f;
  Mesh mesh;
  for (int i = 0; i < segments; ++i) {
    const auto top = [&](int k) {
      const float angle = pi * (1.0f - float(k) / float(segments));
      return glm::vec2(door_half * std::cos(angle), door_springing + door_half * std::sin(angle));
    };
    const glm::vec2 a = top(i);
    const glm::vec2 b = top(i + 1);
    Mesh strip = quad({a.x, 0.0f, z}, {b.x, 0.0f, z}, {b.x, b.y, z}, {a.x, a.y, z});
    // The grain of the wood recipe runs along u: turned upright, one frame for the whole door.
    for (Vertex& v : strip.vertices) v.uv = {v.position.y, v.position.x};
    mesh.append(strip);
  }
  for (const float side : {-1.0f, 1.0f}) {
    for (const float y : {0.14f, 1.15f, 2.18f}) {
      mesh.append(bevelled_box({door_half - 0.05f, 0.20f, 0.05f}, 0.012f),
                  moved({side * 0.5f * door_half, y, z + 0.02f}));
    }
    for (const float x : {0.06f, door_half - 0.07f}) {
      mesh.append(bevelled_box({0.11f, 2.14f, 0.045f}, 0.012f),
                  moved({side * x, 1.16f, z + 0.018f}));
    }
  }
  return mesh;
}

Mesh door_frame() {
  Profile profile({door_half + 0.26f, 0.0f});
  profile.line_by({0.0f, 0.17f})
      .arc_by({-0.05f, 0.04f}, 0.5f, 3)
      .line_by({-0.11f, 0.0f})
      .arc_by({-0.05f, -0.05f}, -0.5f, 4)
      .line_by({-0.05f, 0.0f})
      .line_to({door_half, 0.05f});
  std::vector<Station> stations = arch_stations(18, door_half);
  for (Station& station : stations) station.origin.y = door_springing;
  Station right_foot = stations.front();
  right_foot.origin.y = 0.0f;
  right_foot.distance = -door_springing;
  Station left_foot = stations.back();
  left_foot.origin.y = 0.0f;
  left_foot.distance += door_springing;
  stations.insert(stations.begin(), right_foot);
  stations.push_back(left_foot);
  return sweep(profile, stations);
}

// Places a mesh for the long and one for the end walls on all four sides.
void place_on_walls(Document& document, int long_mesh, int end_mesh) {
  if (long_mesh >= 0) {
    document.place(long_mesh, {0.0f, 0.0f, -plan::walls.y}, 0.0f);
    document.place(long_mesh, {0.0f, 0.0f, plan::walls.y}, 180.0f);
  }
  document.place(end_mesh, {-plan::walls.x, 0.0f, 0.0f}, 90.0f);
  document.place(end_mesh, {plan::walls.x, 0.0f, 0.0f}, -90.0f);
}

}  // namespace

void add_aisle_walls(Document& document, const AtriumMaterials& m) {
  const glm::vec2 length = 2.0f * plan::walls;
  const auto add_ring = [&](const std::string& name, int material,
                            const std::function<Mesh(float)>& make) {
    place_on_walls(document, document.add_mesh(name, make(length.x), material),
                   document.add_mesh(name + "_end", make(length.y), material));
  };
  add_ring("aisle_wall", m.plaster,
           [](float l) { return wall_strip(l, 0.0f, plan::lower.wall_top); });
  add_ring("gallery_wall", m.plaster_upper,
           [](float l) { return wall_strip(l, plan::upper.floor, plan::upper.top); });
  add_ring("dado", m.floor_red, dado);
  add_ring("impost", m.trim, impost);
  Mesh end_frames = field_frames(end_wall_fields());
  end_frames.append(door_frame());
  place_on_walls(document,
                 document.add_mesh("wall_frames", field_frames(long_wall_fields()), m.trim),
                 document.add_mesh("wall_frames_end", std::move(end_frames), m.trim));
  place_on_walls(
      document, document.add_mesh("wall_fresco", field_paintings(long_wall_fields()), m.fresco),
      document.add_mesh("wall_fresco_end", field_paintings(end_wall_fields()), m.fresco));
  place_on_walls(document, -1, document.add_mesh("door", door_leaves(), m.door));

  const int shaft = document.add_mesh("pilaster", pilaster(plan::vault_springing - 0.02f), m.trim);
  for (const plan::Spot& spot : plan::columns()) {
    glm::vec2 on_wall = spot.position;
    float& outwards = spot.on_long_side ? on_wall.y : on_wall.x;
    outwards *= spot.on_long_side ? plan::walls.y / plan::arcade.y : plan::walls.x / plan::arcade.x;
    document.place(shaft, {on_wall.x, 0.0f, on_wall.y}, spot.turn);
  }
}

void add_outer_walls(Document& document, const AtriumMaterials& m) {
  // Under the ridge of the roof, which the coping closes.
  const glm::vec2 extents = plan::arcade + plan::roof_depth;
  constexpr float top = plan::ridge_height - 0.02f;
  Profile wall({0.0f, -0.12f});
  wall.line_to({0.0f, top});
  document.place(document.add_mesh("outer_wall", rectangular_moulding(wall, extents), m.brick), {});
  Profile coping({0.0f, top - 0.16f});
  coping.arc_by({0.10f, 0.08f}, -0.5f, 4)
      .line_by({0.0f, 0.10f})
      .line_to({-0.10f, top + 0.14f})
      .line_to({-0.30f, top + 0.02f})
      .line_to({-0.30f, top - 0.14f});
  document.place(document.add_mesh("coping", rectangular_moulding(coping, extents), m.trim), {});
}

}  // namespace heliograph::scenes
