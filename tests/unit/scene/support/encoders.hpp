#pragma once

#include <array>
#include <glm/glm.hpp>
#include <map>
#include <string>

#include "tests/unit/scene/support/gltf_builder.hpp"

namespace heliograph::scene::test {

/// A mesh before and the ids of its attributes after compression.
struct DracoInput {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;
  std::vector<glm::vec2> uv;
  std::vector<std::array<std::uint8_t, 4>> joints;
  std::vector<std::uint32_t> indices;
  bool sequential = false;
  bool metadata = false;
};

struct DracoOutput {
  Bytes bytes;
  std::map<std::string, std::uint32_t> ids;
  std::uint32_t vertices = 0;
  std::uint32_t triangles = 0;
};

DracoOutput draco(const DracoInput& input);

/// The vertex codec of meshoptimizer, for EXT_meshopt_compression.
Bytes pack_vertices(const Bytes& vertices, std::size_t stride);
Bytes pack_triangles(const std::vector<std::uint32_t>& indices, std::size_t vertex_count);
Bytes pack_sequence(const std::vector<std::uint32_t>& indices, std::size_t vertex_count);
/// Unit vectors as the octahedral filter takes them, four bytes each.
Bytes octahedral(const std::vector<glm::vec4>& vectors);
/// Unit quaternions as the quaternion filter takes them, eight bytes each.
Bytes quaternions(const std::vector<glm::vec4>& rotations);
/// Floats as the exponential filter takes them, three to a vector.
Bytes exponential(const std::vector<glm::vec3>& vectors);

Bytes webp(std::uint32_t width, std::uint32_t height, const Bytes& rgba, bool lossless = true);

}  // namespace heliograph::scene::test
