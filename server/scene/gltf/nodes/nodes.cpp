#include "scene/gltf/nodes/nodes.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <utility>

#include "scene/gltf/nodes/instancing.hpp"

namespace heliograph::scene {
namespace {

struct DocumentNode {
  std::string path;
  Node node;
  NodeAttachments attachments;
  std::vector<std::uint32_t> children;
  bool has_parent = false;
};

glm::mat4 read_matrix(const JsonValue& json) {
  const auto values = json.numbers("matrix", 16);
  glm::mat4 matrix = glm::make_mat4(values->data());
  const glm::vec4 last_row(matrix[0][3], matrix[1][3], matrix[2][3], matrix[3][3]);
  if (glm::distance(last_row, glm::vec4(0.0f, 0.0f, 0.0f, 1.0f)) > 1e-3f) {
    json.refuse("matrix", "is not affine: its last row must be 0 0 0 1");
  }
  for (int column = 0; column < 4; ++column) matrix[column][3] = column == 3 ? 1.0f : 0.0f;
  return matrix;
}

Transform read_transform(const JsonValue& json) {
  const auto translation = json.numbers<3>("translation", {0.0f, 0.0f, 0.0f});
  const auto rotation = json.numbers<4>("rotation", {0.0f, 0.0f, 0.0f, 1.0f});
  const auto scale = json.numbers<3>("scale", {1.0f, 1.0f, 1.0f});
  const glm::dvec4 quaternion(rotation[0], rotation[1], rotation[2], rotation[3]);
  const double length = glm::length(quaternion);
  if (length < 1e-6) json.refuse("rotation", "is not a quaternion of unit length");
  const glm::quat unit(
      static_cast<float>(quaternion.w / length), static_cast<float>(quaternion.x / length),
      static_cast<float>(quaternion.y / length), static_cast<float>(quaternion.z / length));
  return {{translation[0], translation[1], translation[2]}, unit, {scale[0], scale[1], scale[2]}};
}

/// Per mesh of the document: default weights of its morph targets, 0 unless given.
std::vector<std::vector<float>> read_mesh_weights(const JsonValue& root) {
  std::vector<std::vector<float>> weights;
  for (const JsonValue& mesh : root.objects("meshes")) {
    std::size_t count = 0;
    for (const JsonValue& primitive : mesh.objects("primitives")) {
      count = std::max(count, primitive.objects("targets").size());
    }
    auto given = count > 0 ? mesh.numbers("weights", count) : std::nullopt;
    weights.push_back(given ? std::move(*given) : std::vector<float>(count, 0.0f));
  }
  return weights;
}

struct Context {
  std::span<const Accessor> accessors;
  std::size_t nodes;
  std::vector<std::vector<float>> mesh_weights;
  std::size_t cameras;
  std::size_t lights;
  std::size_t skins;
  std::uint64_t instances;  // remaining budget of instances
};

DocumentNode read_node(const JsonValue& json, const Context& context) {
  DocumentNode result;
  result.path = json.path();
  result.node.name = json.text("name");
  if (json.has("matrix")) {
    result.node.local = read_matrix(json);
  } else {
    result.node.transform = read_transform(json);
    result.node.local = result.node.transform->matrix();
  }
  result.children = json.indices("children", context.nodes, "nodes");
  result.attachments.mesh = json.index("mesh", context.mesh_weights.size(), "meshes");
  if (result.attachments.mesh) {
    const std::vector<float>& weights = context.mesh_weights[*result.attachments.mesh];
    result.node.weights = weights;
    if (!weights.empty() && json.has("weights")) {
      result.node.weights = *json.numbers("weights", weights.size());
    }
  }
  result.attachments.camera = json.index("camera", context.cameras, "cameras");
  result.attachments.skin = json.index("skin", context.skins, "skins");
  result.attachments.light = read_node_light(json, context.lights);
  const auto instance_transforms = read_instancing(json, context.accessors, context.instances);
  if (instance_transforms) {
    // Skinned vertices follow joints, not the node.
    if (result.attachments.skin) json.refuse("skin", "cannot be instanced");
    result.attachments.instance_transforms = *instance_transforms;
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

// Every node has at most one parent, so nodes that no root reaches are on or below a cycle.
void check_no_cycles(const std::vector<DocumentNode>& nodes, std::uint32_t max_depth) {
  std::vector<std::uint32_t> roots;
  for (std::uint32_t i = 0; i < nodes.size(); ++i) {
    if (!nodes[i].has_parent) roots.push_back(i);
  }
  const auto ignore = [](std::uint32_t, std::optional<std::uint32_t>) {};
  if (visit_hierarchy(nodes, roots, max_depth, ignore) != nodes.size()) {
    throw ImportError("nodes: the hierarchy has a cycle");
  }
}

std::vector<std::uint32_t> read_roots(const JsonValue& root, const std::vector<DocumentNode>& nodes,
                                      std::optional<std::uint32_t> shown) {
  const std::vector<JsonValue> scenes = root.objects("scenes");
  std::vector<std::vector<std::uint32_t>> roots_of_scene;
  for (const JsonValue& scene : scenes) {
    std::vector<std::uint32_t> roots = scene.indices("nodes", nodes.size(), "nodes");
    std::vector<std::uint32_t> sorted = roots;
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) {
      scene.refuse("nodes", "lists a node twice");
    }
    for (const std::uint32_t node : roots) {
      if (nodes[node].has_parent) scene.refuse("nodes", "lists a node that is not a root");
    }
    roots_of_scene.push_back(std::move(roots));
  }
  if (shown) return roots_of_scene[*shown];
  std::vector<std::uint32_t> all;
  for (std::uint32_t i = 0; i < nodes.size(); ++i) {
    if (!nodes[i].has_parent) all.push_back(i);
  }
  return all;
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

NodeTable read_nodes(const JsonValue& root, std::span<const Accessor> accessors,
                     std::size_t light_count, std::optional<std::uint32_t> shown,
                     const ImportLimits& limits) {
  const std::vector<JsonValue> documents = root.objects("nodes");
  if (documents.size() > limits.nodes) {
    throw ImportError("nodes: " + std::to_string(documents.size()) + " exceed the limit of " +
                      std::to_string(limits.nodes));
  }
  Context context{accessors,
                  documents.size(),
                  read_mesh_weights(root),
                  root.objects("cameras").size(),
                  light_count,
                  root.objects("skins").size(),
                  limits.instances};
  std::vector<DocumentNode> nodes;
  nodes.reserve(documents.size());
  std::uint64_t weights = 0;
  for (const JsonValue& json : documents) {
    nodes.push_back(read_node(json, context));
    context.instances -= nodes.back().attachments.instance_transforms.size();
    weights += nodes.back().node.weights.size();
    if (weights > limits.json_values) json.refuse("has too many morph weights");
  }
  link_parents(nodes);
  check_no_cycles(nodes, limits.node_depth);

  NodeTable table;
  table.of_document.resize(nodes.size());
  visit_hierarchy(nodes, read_roots(root, nodes, shown), limits.node_depth,
                  [&](std::uint32_t index, std::optional<std::uint32_t> parent) {
                    Node node = nodes[index].node;
                    node.parent = parent;
                    node.world = parent ? table.nodes[*parent].world * node.local : node.local;
                    table.of_document[index] = static_cast<std::uint32_t>(table.nodes.size());
                    table.nodes.push_back(std::move(node));
                    table.attachments.push_back(nodes[index].attachments);
                    table.paths.push_back(nodes[index].path);
                  });
  add_places(table);
  return table;
}

}  // namespace heliograph::scene
