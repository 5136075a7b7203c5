#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "scene/gltf/document/accessors.hpp"
#include "scene/gltf/document/gltf_file.hpp"
#include "scene/gltf/nodes/lights.hpp"
#include "scene/scene.hpp"
#include "scene/warnings.hpp"

namespace heliograph::scene {

/// Objects attached to a node, as indices into the document's arrays.
struct NodeAttachments {
  std::optional<std::uint32_t> mesh;
  std::optional<std::uint32_t> skin;
  std::optional<std::uint32_t> camera;
  NodeLight light;
  std::vector<Transform>
      instance_transforms;  // EXT_mesh_gpu_instancing: instance transforms relative to the node
};

/// The nodes of the selected scene, parents first, with world transforms. `attachments[i]` belongs
/// to `nodes[i]`; `paths[i]` names it in errors.
struct NodeTable {
  std::vector<Node> nodes;
  std::vector<NodeAttachments> attachments;
  std::vector<std::string> paths;
  std::vector<std::optional<std::uint32_t>>
      of_document;  // index into `nodes`, by index in the file
};

/// Reads all nodes, rejects cycles, second parents and excessive depth, and keeps those of scene
/// `shown`, or all where there is none. A node that a scene lists although its parent is shown
/// stays where its parent puts it. A node with mesh instances gets one child per instance. Nodes
/// that are never visible, and those below them, keep their cameras only.
/// @throws ImportError, LoadCancelled
NodeTable read_nodes(const tinygltf::Model& model, std::span<const Accessor> accessors,
                     std::optional<std::uint32_t> shown, const ImportLimits& limits,
                     Warnings& warnings, const std::stop_token& stop);

}  // namespace heliograph::scene
