#include "scene/gltf/geometry/shapes.hpp"

#include <string>

namespace heliograph::scene {
namespace {

std::vector<glm::vec3> read_differences(std::optional<std::uint32_t> accessor,
                                        std::span<const Accessor> accessors,
                                        std::span<const std::uint32_t> sources) {
  std::vector<glm::vec3> result;
  if (!accessor) return result;
  const std::vector<glm::vec3> values = read_vectors<3>(accessors[*accessor]);
  result.reserve(sources.size());
  for (const std::uint32_t source : sources) result.push_back(values[source]);
  return result;
}

/// Normalizes weights to sum 1; a vertex without weights follows its first joint.
void normalize(std::span<JointWeight> influences) {
  float sum = 0.0f;
  for (const JointWeight& influence : influences) sum += influence.weight;
  if (sum <= 0.0f) {
    influences.front().weight = 1.0f;
    return;
  }
  for (JointWeight& influence : influences) influence.weight /= sum;
}

void read_influences(const Primitive& primitive, std::span<const Accessor> accessors,
                     std::span<const std::uint32_t> sources, Shape& shape) {
  const std::uint32_t sets = primitive.joints[1] ? 2 : 1;
  shape.joints_per_vertex = 4 * sets;
  shape.influences.resize(sources.size() * shape.joints_per_vertex);
  for (std::uint32_t set = 0; set < sets; ++set) {
    const Accessor& weight_accessor = accessors[*primitive.weights[set]];
    const auto joints = read_vectors<4>(accessors[*primitive.joints[set]]);
    const auto weights = read_vectors<4>(weight_accessor);
    for (std::size_t i = 0; i < sources.size(); ++i) {
      for (int lane = 0; lane < 4; ++lane) {
        const float weight = weights[sources[i]][lane];
        if (weight < 0.0f) weight_accessor.refuse("holds a negative weight");
        JointWeight& target = shape.influences[i * shape.joints_per_vertex + 4 * set + lane];
        // A joint of weight 0 may have any index.
        if (weight > 0.0f) {
          target = {static_cast<std::uint32_t>(joints[sources[i]][lane]), weight};
        }
      }
    }
  }
  for (std::size_t i = 0; i < sources.size(); ++i) {
    normalize(
        std::span(shape.influences).subspan(i * shape.joints_per_vertex, shape.joints_per_vertex));
  }
}

}  // namespace

Shape build_shape(const Primitive& primitive, std::span<const Accessor> accessors, const Mesh& mesh,
                  std::span<const std::uint32_t> sources) {
  Shape shape;
  shape.vertices = mesh.vertices;
  shape.flat = !primitive.normal;
  for (const Primitive::Target& target : primitive.targets) {
    shape.targets.push_back({read_differences(target.position, accessors, sources),
                             read_differences(target.normal, accessors, sources),
                             read_differences(target.tangent, accessors, sources)});
  }
  if (primitive.joints[0]) read_influences(primitive, accessors, sources, shape);
  return shape;
}

void check_joints(const Shape& shape, const Skin& skin, const std::string& path) {
  for (const JointWeight& influence : shape.influences) {
    if (influence.joint < skin.joints.size()) continue;
    throw ImportError(path + ".mesh: joint " + std::to_string(influence.joint) +
                      " is out of range for a skin with " + std::to_string(skin.joints.size()) +
                      " joints");
  }
}

}  // namespace heliograph::scene
