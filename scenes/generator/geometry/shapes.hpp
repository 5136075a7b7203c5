#pragma once

#include <functional>
#include <vector>

#include "scenes/generator/geometry/mesh.hpp"
#include "scenes/generator/geometry/profile.hpp"

namespace heliograph::scenes {

struct SurfacePoint {
  glm::vec3 position{0.0f};
  glm::vec3 normal{0.0f, 1.0f, 0.0f};
  glm::vec2 uv{0.0f};  // metres
};

/// A smooth patch over (u, v) in [0,1]^2 with columns x rows quads. `surface` gives exact normals;
/// the winding follows them.
Mesh patch(int columns, int rows, const std::function<SurfacePoint(float u, float v)>& surface);

/// The same for a position alone, whose derivative exists everywhere: normals are the cross
/// product of central differences (d/du x d/dv), uv is (u, v) * extent.
Mesh smooth_patch(int columns, int rows, glm::vec2 extent,
                  const std::function<glm::dvec3(double u, double v)>& position);

/// Turns `profile` (x = radius, y = height) once round the Y axis. uv: along the circumference at
/// `reference_radius` and down the profile, both in metres. The repeats round the axis are rounded
/// to a whole number of `tile` metres, so that the seam does not show.
Mesh lathe(const Profile& profile, int segments, float reference_radius, float tile);

/// Where a swept profile stands: its x axis, its y axis and the distance travelled.
struct Station {
  glm::vec3 origin{0.0f};
  glm::vec3 axis_x{1.0f, 0.0f, 0.0f};
  glm::vec3 axis_y{0.0f, 1.0f, 0.0f};
  float distance = 0.0f;
};

/// Sweeps `profile` along the stations; ends stay open.
Mesh sweep(const Profile& profile, const std::vector<Station>& stations);

/// Stations of a straight sweep along +X from -length/2 to +length/2; profile x points along +Z.
std::vector<Station> straight_stations(float length, int segments = 1);

/// Stations of a half circle (centre at the origin, in the XY plane, from +X over +Y to -X);
/// profile x is radial, profile y points along +Z.
std::vector<Station> arch_stations(int segments, float reference_radius, float from_angle = 0.0f,
                                   float to_angle = 3.14159265f);

/// A flat polygon patch with four corners in counter-clockwise order; uv in metres, u along the
/// first edge, v against the last one.
Mesh quad(glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d);

/// The same with the corners in either order: turned so that its normal agrees with `outward`.
Mesh quad_facing(glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d, glm::vec3 outward);

/// Runs `profile` round a rectangle in the XZ plane with mitred corners: profile x is the distance
/// outwards from `half_extents`, profile y the height.
Mesh rectangular_moulding(const Profile& profile, glm::vec2 half_extents);

/// A box centred on the origin; every face has uv in metres, upright on the vertical faces.
Mesh box(glm::vec3 size);

/// A box whose edges are cut by flat bevels of the given width.
Mesh bevelled_box(glm::vec3 size, float bevel);

/// A sphere about the origin with exact normals; u runs once round, v from pole to pole.
Mesh sphere(float radius, int segments, int rings, glm::vec2 uv_extent);

/// A torus about the Y axis.
Mesh torus(float ring_radius, float tube_radius, int segments, int sides);

/// A flat disc facing +Y, with planar uv in metres.
Mesh disc(float radius, int segments);

}  // namespace heliograph::scenes
