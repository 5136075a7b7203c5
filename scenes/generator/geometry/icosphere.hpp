#pragma once

#include <functional>

#include "scenes/generator/geometry/mesh.hpp"
#include "scenes/generator/geometry/shapes.hpp"

namespace heliograph::scenes {

/// A sphere of 20 * 4^level triangles (a subdivided icosahedron) with exact normals. uv runs once
/// round and from pole to pole, in metres.
Mesh icosphere(float radius, int level);

/// The same with flat faces, uv lying in each face.
Mesh faceted_icosphere(float radius, int level);

/// The same carried onto any star-shaped surface: `surface` gives position and exact normal for a
/// unit direction; its uv is not used.
Mesh icosphere(int level, glm::vec2 uv_extent,
               const std::function<SurfacePoint(glm::vec3 direction)>& surface);

}  // namespace heliograph::scenes
