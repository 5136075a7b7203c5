#include "scene/gltf/nodes/placement.hpp"

#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "scene/animation/deform.hpp"
#include "scene/gltf/geometry/shapes.hpp"
#include "scene/gltf/nodes/cameras.hpp"
#include "scene/gltf/nodes/lights.hpp"
#include "scene/import_error.hpp"

namespace heliograph::scene {
namespace {

// Coordinate limit: float32 has no useful precision beyond it.
constexpr float farthest = 1e12f;

bool is_finite(const glm::mat4& matrix) {
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) {
      if (!std::isfinite(matrix[column][row])) return false;
    }
  }
  return true;
}

class Placement {
 public:
  Placement(Scene& scene, const PlacementContext& context) : scene_(scene), context_(context) {}

  void place_instances(const NodeTable& nodes, const PrimitiveTable& primitives) {
    const std::vector<bool> moves = moved_by_clips();
    const Pose pose = rest_pose(scene_);
    for (std::uint32_t i = 0; i < nodes.nodes.size(); ++i) {
      throw_if_cancelled(context_.stop, i);
      const NodeAttachments& attached = nodes.attachments[i];
      if (!attached.mesh) continue;
      const float determinant = glm::determinant(glm::mat3(nodes.nodes[i].world));
      for (const std::uint32_t mesh : primitives.of_mesh[*attached.mesh]) {
        const Shape& shape = scene_.shapes[mesh];
        const bool skinned = attached.skin && shape.joints_per_vertex > 0 &&
                             !scene_.skins[*attached.skin].joints.empty();
        if (!skinned && !std::isnormal(determinant) && !moves[i]) {
          context_.warnings.add(nodes.paths[i] + " has zero scale and was left out");
          continue;
        }
        if (skinned || !shape.targets.empty()) {
          place_deforming(mesh, i, skinned ? attached.skin : std::nullopt, pose, nodes.paths[i]);
        } else {
          place_instance(mesh, i, nodes.paths[i]);
        }
      }
    }
  }

  void place_lights_and_cameras(const NodeTable& nodes, const std::vector<Light>& lights,
                                const std::vector<Camera>& cameras) {
    for (std::size_t i = 0; i < nodes.nodes.size(); ++i) {
      const Node& node = nodes.nodes[i];
      const auto index = static_cast<std::uint32_t>(i);
      const NodeAttachments& attached = nodes.attachments[i];
      if ((attached.light || attached.camera) && !is_finite(node.world)) {
        throw ImportError(nodes.paths[i] +
                          ": places its light or camera beyond the coordinate limit");
      }
      if (attached.light) {
        scene_.lights.push_back(place_light(lights, attached.light, node.name, node.world));
        scene_.lights.back().node = index;
      }
      if (attached.camera) {
        scene_.cameras.push_back(
            place_camera(cameras[*attached.camera], node.name, node.world, scene_.bounds));
        scene_.cameras.back().node = index;
      }
    }
    name_apart(scene_.cameras);
  }

 private:
  /// Nodes that a clip moves, directly or through an ancestor.
  std::vector<bool> moved_by_clips() const {
    std::vector<bool> moves(scene_.nodes.size());
    for (const Clip& clip : scene_.clips) {
      for (const Channel& channel : clip.channels) moves[channel.node] = true;
    }
    for (std::size_t i = 0; i < moves.size(); ++i) {
      const auto& parent = scene_.nodes[i].parent;
      if (parent && moves[*parent]) moves[i] = true;
    }
    return moves;
  }

  void place_instance(std::uint32_t mesh, std::uint32_t node, const std::string& path) {
    scene_.instances.push_back({mesh, node});
    if (scene_.instances.size() > context_.limits.instances) {
      throw ImportError("the scene exceeds the limit of " +
                        std::to_string(context_.limits.instances) + " instances");
    }
    include_in_bounds(scene_.meshes[mesh].bounds, scene_.nodes[node].world, path);
  }

  // Every instance gets its own mesh, because each may deform differently.
  void place_deforming(std::uint32_t mesh, std::uint32_t node, std::optional<std::uint32_t> skin,
                       const Pose& pose, const std::string& path) {
    const std::uint32_t shape = mesh;
    pay_for_deforming(scene_.shapes[shape], skin, path);
    if (skin) check_joints(scene_.shapes[shape], scene_.skins[*skin], path);
    if (!placed_shapes_.insert(shape).second) mesh = copy_mesh(mesh);
    scene_.deformations.push_back({mesh, shape, node, skin});
    Mesh& own = scene_.meshes[mesh];
    own.bounds = deform(scene_, scene_.deformations.back(), pose, own.vertices);
    place_instance(mesh, skin ? origin_node() : node, path);
  }

  /// Charges vertices, joint matrices and morph target work of every instance: nodes that share a
  /// mesh cost nothing in the file.
  void pay_for_deforming(const Shape& shape, std::optional<std::uint32_t> skin,
                         const std::string& path) {
    context_.budget.take(shape.vertices.size(),
                         sizeof(shared::Vertex) + shape.targets.size() * sizeof(glm::vec3), path);
    if (skin) context_.budget.take(scene_.skins[*skin].joints.size(), sizeof(glm::mat4), path);
  }

  std::uint32_t copy_mesh(std::uint32_t mesh) {
    scene_.meshes.push_back(Mesh(scene_.meshes[mesh]));
    return static_cast<std::uint32_t>(scene_.meshes.size() - 1);
  }

  std::uint32_t origin_node() {
    if (!origin_) {
      origin_ = static_cast<std::uint32_t>(scene_.nodes.size());
      scene_.nodes.push_back({.name = "skinned"});
    }
    return *origin_;
  }

  void include_in_bounds(const Bounds& mesh, const glm::mat4& world, const std::string& path) {
    for (int corner = 0; corner < 8; ++corner) {
      const glm::vec3 point(corner & 1 ? mesh.maximum.x : mesh.minimum.x,
                            corner & 2 ? mesh.maximum.y : mesh.minimum.y,
                            corner & 4 ? mesh.maximum.z : mesh.minimum.z);
      const glm::vec3 placed(world * glm::vec4(point, 1.0f));
      for (int axis = 0; axis < 3; ++axis) {
        if (!(std::abs(placed[axis]) <= farthest))
          throw ImportError(path + ": places its mesh beyond the coordinate limit");
      }
      scene_.bounds.include(placed);
    }
  }

  Scene& scene_;
  const PlacementContext& context_;
  std::optional<std::uint32_t> origin_;  // parent node of skinned meshes
  std::set<std::uint32_t> placed_shapes_;
};

}  // namespace

void place_objects(Scene& scene, const NodeTable& nodes, const PlacedObjects& objects,
                   const PlacementContext& context) {
  Placement placement(scene, context);
  placement.place_instances(nodes, objects.primitives);
  placement.place_lights_and_cameras(nodes, objects.lights, objects.cameras);
}

}  // namespace heliograph::scene
