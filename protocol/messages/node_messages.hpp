#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "protocol/json/fields.hpp"
#include "protocol/limits.hpp"
#include "protocol/messages/loading_messages.hpp"

// Messages about the nodes of a scene: their hierarchy, which of them are shown, and which are
// selected. Nodes are named by ids, since their names are not unique: an id is valid as long as the
// scene is shown, and the same whenever the same file is.

namespace heliograph::protocol {

struct NodeInfo {
  std::uint32_t id = 0;
  std::optional<std::uint32_t> parent;
  std::string name;
  std::uint32_t meshes = 0;
  bool visible = true;

  static constexpr auto fields() {
    return std::tuple{
        field("id", &NodeInfo::id, "Number of the node; parents have smaller ones."),
        field("parent", &NodeInfo::parent, "Id of its parent; null: it has none.").or_null(),
        field("name", &NodeInfo::name, "Its name, otherwise that of its mesh; may be empty."),
        field("meshes", &NodeInfo::meshes, "Meshes at the node itself."),
        field("visible", &NodeInfo::visible,
              "Whether it is visible, unless a node above it is not or others are isolated."),
    };
  }
  bool operator==(const NodeInfo&) const = default;
};

struct NodesList {
  std::optional<std::string> search;
  std::uint32_t first = 0;
  std::uint32_t count = 1000;

  static constexpr auto fields() {
    return std::tuple{
        field("search", &NodesList::search,
              "Part of the names to list, in any case; absent: all nodes.")
            .length(1, max_node_name),
        field("first", &NodesList::first, "How many nodes to leave out at the beginning.")
            .or_default(),
        field("count", &NodesList::count, "Most nodes to list.")
            .range(1, max_listed_nodes)
            .or_default(),
    };
  }
  bool operator==(const NodesList&) const = default;
};

struct NodeList {
  std::vector<NodeInfo> nodes;
  std::uint32_t total = 0;
  std::vector<std::uint32_t> isolated;
  std::uint32_t rev = 0;

  static constexpr auto fields() {
    return std::tuple{
        field("nodes", &NodeList::nodes, "Parents come before their children."),
        field("total", &NodeList::total, "Nodes that there are, or that match the search."),
        field("isolated", &NodeList::isolated, "See nodes.isolate."),
        field("rev", &NodeList::rev, "Revision of the session's state."),
    };
  }
  bool operator==(const NodeList&) const = default;
};

/// Some nodes by their ids.
struct NodeIds {
  std::vector<std::uint32_t> nodes;

  static constexpr auto fields() {
    return std::tuple{
        field("nodes", &NodeIds::nodes, "Ids from nodes.list.").length(0, max_listed_nodes),
    };
  }
  bool operator==(const NodeIds&) const = default;
};

struct NodeProperties {
  std::vector<std::string> names;
  std::uint64_t triangles = 0;
  std::uint64_t instances = 0;
  std::optional<Bounds> bounds;
  std::vector<std::string> materials;
  bool shown = false;

  static constexpr auto fields() {
    return std::tuple{
        field("names", &NodeProperties::names, "Names of the nodes, in the order of the request."),
        field("triangles", &NodeProperties::triangles, "Of them and all nodes below them."),
        field("instances", &NodeProperties::instances, "Placed meshes, likewise."),
        field("bounds", &NodeProperties::bounds,
              "World space box around their meshes before any animation; null: they have none.")
            .or_null(),
        field("materials", &NodeProperties::materials, "Names for materials.patch."),
        field("shown", &NodeProperties::shown,
              "Whether any of their meshes is shown, which also depends on the nodes above and on "
              "nodes.isolate."),
    };
  }
  bool operator==(const NodeProperties&) const = default;
};

struct NodePatch {
  static constexpr bool strict = true;
  Change<bool> visible;

  static constexpr auto fields() {
    return std::tuple{
        field("visible", &NodePatch::visible,
              "Whether the nodes and those below them are seen, cast shadows and are reflected."),
    };
  }
  bool operator==(const NodePatch&) const = default;
};

struct NodesPatch {
  std::vector<std::uint32_t> nodes;
  NodePatch patch;

  static constexpr auto fields() {
    return std::tuple{
        field("nodes", &NodesPatch::nodes, "Ids from nodes.list.").length(1, max_listed_nodes),
        field("patch", &NodesPatch::patch,
              "A merge patch (RFC 7386); null restores the value of the scene file."),
    };
  }
  bool operator==(const NodesPatch&) const = default;
};

/// What of a scene is not shown.
struct NodesVisibility {
  std::vector<std::uint32_t> hidden;
  std::vector<std::uint32_t> isolated;
  std::uint32_t rev = 0;

  static constexpr auto fields() {
    return std::tuple{
        field("hidden", &NodesVisibility::hidden, "Ids of all nodes that are not visible."),
        field("isolated", &NodesVisibility::isolated, "See nodes.isolate."),
        field("rev", &NodesVisibility::rev, "Revision of the session's state."),
    };
  }
  bool operator==(const NodesVisibility&) const = default;
};

struct NodesChanged {
  std::vector<std::uint32_t> hidden;
  std::vector<std::uint32_t> isolated;
  std::uint32_t rev = 0;
  std::string by;

  static constexpr auto fields() {
    return std::tuple{
        field("hidden", &NodesChanged::hidden, "Ids of all nodes that are not visible."),
        field("isolated", &NodesChanged::isolated, "See nodes.isolate."),
        field("rev", &NodesChanged::rev, "Revision of the session's state."),
        field("by", &NodesChanged::by, "The viewer that changed it; empty: the server."),
    };
  }
  bool operator==(const NodesChanged&) const = default;
};

struct Selection {
  std::vector<std::uint32_t> nodes;
  std::uint32_t rev = 0;

  static constexpr auto fields() {
    return std::tuple{
        field("nodes", &Selection::nodes, "Ids of the selected nodes, ascending."),
        field("rev", &Selection::rev, "Revision of the session's state."),
    };
  }
  bool operator==(const Selection&) const = default;
};

struct SelectionChanged {
  std::vector<std::uint32_t> nodes;
  std::uint32_t rev = 0;
  std::string by;

  static constexpr auto fields() {
    return std::tuple{
        field("nodes", &SelectionChanged::nodes, "Ids of the selected nodes, ascending."),
        field("rev", &SelectionChanged::rev, "Revision of the session's state."),
        field("by", &SelectionChanged::by, "The viewer that selected them; empty: the server."),
    };
  }
  bool operator==(const SelectionChanged&) const = default;
};

/// What camera.fit shows.
struct CameraFit {
  std::optional<std::vector<std::uint32_t>> nodes;

  static constexpr auto fields() {
    return std::tuple{
        field("nodes", &CameraFit::nodes,
              "Ids from nodes.list, which are shown with all below them; absent: the whole scene.")
            .length(1, max_listed_nodes),
    };
  }
  bool operator==(const CameraFit&) const = default;
};

}  // namespace heliograph::protocol
