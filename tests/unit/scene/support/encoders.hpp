#pragma once

#include <array>
#include <glm/glm.hpp>
#include <map>
#include <string>

#include "tests/unit/scene/support/gltf_builder.hpp"

namespace heliograph::scene::test {

/// A mesh before compression, and its attribute ids after it.
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
/// Unit vectors encoded for the octahedral filter, 4 bytes each.
Bytes octahedral(const std::vector<glm::vec4>& vectors);
/// Unit quaternions encoded for the quaternion filter, 8 bytes each.
Bytes quaternions(const std::vector<glm::vec4>& rotations);
/// Float vectors encoded for the exponential filter.
Bytes exponential(const std::vector<glm::vec3>& vectors);

Bytes webp(std::uint32_t width, std::uint32_t height, const Bytes& rgba, bool lossless = true);

}  // namespace heliograph::scene::test
