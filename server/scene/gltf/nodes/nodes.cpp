#include "scene/gltf/nodes/nodes.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <utility>

#include "scene/gltf/document/extension_value.hpp"
#include "scene/gltf/nodes/animation_pointer.hpp"
#include "scene/gltf/nodes/instancing.hpp"
#include "scene/import_error.hpp"

namespace heliograph::scene {
namespace {

struct DocumentNode {
  std::string path;
  Node node;
  NodeAttachments attachments;
  std::vector<std::uint32_t> children;
  bool visible = true;
  bool may_appear = true;  // it is visible, or an animation may show it
  bool has_parent = false;
};

std::vector<std::uint32_t> to_indices(const std::vector<int>& indices) {
  return {indices.begin(), indices.end()};
}

glm::mat4 to_matrix(const tinygltf::Node& document, const std::string& path) {
  glm::mat4 matrix(glm::make_mat4(document.matrix.data()));
  const glm::vec4 last_row(matrix[0][3], matrix[1][3], matrix[2][3], matrix[3][3]);
  if (glm::distance(last_row, glm::vec4(0.0f, 0.0f, 0.0f, 1.0f)) > 1e-3f) {
    refuse_at(path, "matrix", "is not affine: its last row must be 0 0 0 1");
  }
  for (int column = 0; column < 4; ++column) matrix[column][3] = column == 3 ? 1.0f : 0.0f;
  return matrix;
}

Transform to_transform(const tinygltf::Node& document, const std::string& path) {
  Transform transform;
  if (!document.translation.empty()) {
    transform.translation = glm::make_vec3(document.translation.data());
  }
  if (!document.scale.empty()) transform.scale = glm::make_vec3(document.scale.data());
  if (document.rotation.empty()) return transform;
  const glm::dvec4 quaternion = glm::make_vec4(document.rotation.data());
  const double length = glm::length(quaternion);
  if (length < 1e-6) refuse_at(path, "rotation", "is not a quaternion of unit length");
  transform.rotation = glm::quat(glm::dquat(quaternion.w / length, quaternion.x / length,
                                            quaternion.y / length, quaternion.z / length));
  return transform;
}

/// The weights of an object at `path`, for a mesh with `count` morph targets.
std::vector<float> to_weights(const std::vector<double>& given, std::size_t count,
                              const std::string& path) {
  if (given.size() != count) {
    refuse_at(path, "weights", "must be an array of " + std::to_string(count) + " numbers");
  }
  return {given.begin(), given.end()};
}

/// Per mesh of the document: default weights of its morph targets, 0 unless given.
std::vector<std::vector<float>> read_mesh_weights(const tinygltf::Model& model) {
  std::vector<std::vector<float>> weights;
  for (const tinygltf::Mesh& mesh : model.meshes) {
    std::size_t count = 0;
    for (const tinygltf::Primitive& primitive : mesh.primitives) {
      count = std::max(count, primitive.targets.size());
    }
    const bool given = count > 0 && !mesh.weights.empty();
    weights.push_back(given
                          ? to_weights(mesh.weights, count, item_path("", "meshes", weights.size()))
                          : std::vector<float>(count, 0.0f));
  }
  return weights;
}

struct Context {
  std::span<const Accessor> accessors;
  std::vector<std::vector<float>> mesh_weights;
  std::uint64_t instances;  // remaining budget of instances
};

DocumentNode read_node(const tinygltf::Node& document, std::string path, const Context& context) {
  DocumentNode result;
  result.path = std::move(path);
  result.node.name = document.name;
  if (!document.matrix.empty()) {
    result.node.local = to_matrix(document, result.path);
  } else {
    result.node.transform = to_transform(document, result.path);
    result.node.local = result.node.transform->matrix();
  }
  result.children = to_indices(document.children);
  result.attachments.mesh = to_index(document.mesh);
  if (result.attachments.mesh) {
    const std::vector<float>& weights = context.mesh_weights[*result.attachments.mesh];
    result.node.weights = weights;
    if (!weights.empty() && !document.weights.empty()) {
      result.node.weights = to_weights(document.weights, weights.size(), result.path);
    }
  }
  result.attachments.camera = to_index(document.camera);
  result.attachments.skin = to_index(document.skin);
  result.attachments.light = read_node_light(document, result.path);
  if (const auto own = find_extension(document.extensions, "KHR_node_visibility", result.path)) {
    result.visible = own->boolean("visible", true);
  }
  auto instance_transforms =
      read_instancing(document, result.path, context.accessors, context.instances);
  if (instance_transforms) {
    // Skinned vertices follow joints, not the node.
    if (result.attachments.skin) refuse_at(result.path, "skin", "cannot be instanced");
    result.attachments.instance_transforms = std::move(*instance_transforms);
  }
  return result;
}

void link_parents(std::vector<DocumentNode>& nodes) {
  for (const DocumentNode& node : nodes) {
    for (const std::uint32_t child : node.children) {
      if (std::exchange(nodes[child].has_parent, true)) {
        throw ImportError(nodes[child].path + ": has more than one parent");
      }
    }
  }
}

// Visits `roots` and all below, parents first; returns how many nodes there were.
template <typename Visit>
std::size_t visit_hierarchy(const std::vector<DocumentNode>& nodes,
                            const std::vector<std::uint32_t>& roots, std::uint32_t max_depth,
                            Visit visit) {
  struct Pending {
    std::uint32_t node;
    std::optional<std::uint32_t> parent;  // in order of visiting
    std::uint32_t depth;
  };
  std::vector<Pending> pending;
  for (auto root = roots.rbegin(); root != roots.rend(); ++root)
    pending.push_back({*root, std::nullopt, 1});
  std::uint32_t visited = 0;
  while (!pending.empty()) {
    const Pending next = pending.back();
    pending.pop_back();
    const DocumentNode& node = nodes[next.node];
    if (next.depth > max_depth) {
      throw ImportError(node.path + ": is deeper than " + std::to_string(max_depth) + " levels");
    }
    visit(next.node, next.parent);
    for (auto child = node.children.rbegin(); child != node.children.rend(); ++child) {
      pending.push_back({*child, visited, next.depth + 1});
    }
    ++visited;
  }
  return visited;
}

std::vector<std::uint32_t> all_roots(const std::vector<DocumentNode>& nodes) {
  std::vector<std::uint32_t> roots;
  for (std::uint32_t i = 0; i < nodes.size(); ++i) {
    if (!nodes[i].has_parent) roots.push_back(i);
  }
  return roots;
}

// Every node has at most one parent, so nodes that no root reaches are on or below a cycle.
void check_no_cycles(const std::vector<DocumentNode>& nodes, std::uint32_t max_depth) {
  const auto ignore = [](std::uint32_t, std::optional<std::uint32_t>) {};
  if (visit_hierarchy(nodes, all_roots(nodes), max_depth, ignore) != nodes.size()) {
    throw ImportError("nodes: the hierarchy has a cycle");
  }
}

/// The nodes that a scene lists, without those below others that it lists.
std::vector<std::uint32_t> roots_of_scene(const tinygltf::Scene& scene, const std::string& path,
                                          const std::vector<DocumentNode>& nodes,
                                          std::uint32_t max_depth, Warnings& warnings) {
  std::vector<std::uint32_t> roots = to_indices(scene.nodes);
  std::vector<std::uint32_t> sorted = roots;
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) {
    refuse_at(path, "nodes", "lists a node twice");
  }
  const auto has_parent = [&](std::uint32_t root) { return nodes[root].has_parent; };
  if (std::ranges::none_of(roots, has_parent)) return roots;
  std::vector<bool> below(nodes.size());
  for (const std::uint32_t root : roots) {
    if (below[root]) continue;
    visit_hierarchy(nodes, {root}, max_depth,
                    [&](std::uint32_t node, std::optional<std::uint32_t>) {
                      below[node] = below[node] || node != root;
                    });
  }
  for (const std::uint32_t root : roots) {
    if (below[root])
      warnings.add(path + ".nodes lists " + nodes[root].path + ", which has a parent");
  }
  std::erase_if(roots, [&](std::uint32_t root) { return below[root]; });
  return roots;
}

std::vector<std::uint32_t> read_roots(const tinygltf::Model& model,
                                      const std::vector<DocumentNode>& nodes,
                                      std::optional<std::uint32_t> shown, std::uint32_t max_depth,
                                      Warnings& warnings) {
  std::vector<std::uint32_t> shown_roots;
  for (std::uint32_t i = 0; i < model.scenes.size(); ++i) {
    auto roots =
        roots_of_scene(model.scenes[i], item_path("", "scenes", i), nodes, max_depth, warnings);
    if (shown == i) shown_roots = std::move(roots);
  }
  return shown ? shown_roots : all_roots(nodes);
}

/// Appends one child node per instance of EXT_mesh_gpu_instancing.
void add_places(NodeTable& table) {
  const std::size_t count = table.nodes.size();
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::vector<Transform> instance_transforms =
        std::move(table.attachments[i].instance_transforms);
    if (instance_transforms.empty()) continue;
    const auto mesh = std::exchange(table.attachments[i].mesh, std::nullopt);
    for (const Transform& instance : instance_transforms) {
      Node node;
      node.name = table.nodes[i].name;
      node.parent = i;
      node.local = instance.matrix();
      node.world = table.nodes[i].world * node.local;
      node.transform = instance;
      node.weights = table.nodes[i].weights;
      table.nodes.push_back(std::move(node));
      table.attachments.emplace_back().mesh = mesh;
      table.paths.push_back(table.paths[i]);
    }
  }
}

}  // namespace

NodeTable read_nodes(const tinygltf::Model& model, std::span<const Accessor> accessors,
                     std::optional<std::uint32_t> shown, const ImportLimits& limits,
                     Warnings& warnings, const std::stop_token& stop) {
  if (model.nodes.size() > limits.nodes) {
    throw ImportError("nodes: " + std::to_string(model.nodes.size()) + " exceed the limit of " +
                      std::to_string(limits.nodes));
  }
  Context context{accessors, read_mesh_weights(model), limits.instances};
  std::vector<DocumentNode> nodes;
  nodes.reserve(model.nodes.size());
  const std::vector<bool> blink = nodes_that_blink(model);
  std::uint64_t weights = 0;
  for (const tinygltf::Node& document : model.nodes) {
    throw_if_cancelled(stop, nodes.size());
    const bool blinks = blink[nodes.size()];
    nodes.push_back(read_node(document, item_path("", "nodes", nodes.size()), context));
    nodes.back().may_appear = nodes.back().visible || blinks;
    context.instances -= nodes.back().attachments.instance_transforms.size();
    weights += nodes.back().node.weights.size();
    if (weights > limits.json_values) refuse_at(nodes.back().path, "has too many morph weights");
  }
  link_parents(nodes);
  check_no_cycles(nodes, limits.node_depth);

  NodeTable table;
  table.of_document.resize(nodes.size());
  std::vector<bool> appears;  // the table's nodes, ever
  visit_hierarchy(nodes, read_roots(model, nodes, shown, limits.node_depth, warnings),
                  limits.node_depth, [&](std::uint32_t index, std::optional<std::uint32_t> parent) {
                    Node node = nodes[index].node;
                    node.parent = parent;
                    node.visible = nodes[index].visible || !nodes[index].may_appear;
                    node.world = parent ? table.nodes[*parent].world * node.local : node.local;
                    table.of_document[index] = static_cast<std::uint32_t>(table.nodes.size());
                    table.nodes.push_back(std::move(node));
                    appears.push_back(nodes[index].may_appear && (!parent || appears[*parent]));
                    NodeAttachments attachments = nodes[index].attachments;
                    if (!appears.back()) attachments = {.camera = attachments.camera};
                    table.attachments.push_back(std::move(attachments));
                    table.paths.push_back(nodes[index].path);
                  });
  add_places(table);
  return table;
}

}  // namespace heliograph::scene
