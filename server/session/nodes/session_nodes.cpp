#include "session/nodes/session_nodes.hpp"

#include "session/nodes/node_properties.hpp"

namespace heliograph::session {

using protocol::Result;

Result<void> SessionNodes::check(const std::vector<std::uint32_t>& nodes) const {
  if (const Result<void> loaded = core_.require_scene(); !loaded) return loaded;
  return core_.nodes.check(nodes, "nodes");
}

Result<protocol::NodeList> SessionNodes::list(const protocol::NodesList& request) const {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> loaded = core_.require_scene(); !loaded) return loaded.error();
  protocol::NodeList list = list_nodes(*core_.scene, core_.nodes, request);
  list.rev = core_.rev;
  return list;
}

Result<protocol::NodeProperties> SessionNodes::properties(const protocol::NodeIds& request) const {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> known = check(request.nodes); !known) return known.error();
  return node_properties(*core_.scene, core_.nodes, request.nodes);
}

Result<protocol::NodesVisibility> SessionNodes::patch(const protocol::NodesPatch& request,
                                                      const std::string& by) {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> known = check(request.nodes); !known) return known.error();
  const protocol::Change<bool>& visible = request.patch.visible;
  const bool changed = (visible.value || visible.reset) &&
                       core_.nodes.set_visible(request.nodes, visible.value.value_or(true));
  return publish_visibility(changed, by);
}

Result<protocol::NodesVisibility> SessionNodes::isolate(const protocol::NodeIds& request,
                                                        const std::string& by) {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> known = check(request.nodes); !known) return known.error();
  return publish_visibility(core_.nodes.isolate(request.nodes), by);
}

protocol::NodesVisibility SessionNodes::publish_visibility(bool changed, const std::string& by) {
  if (changed) core_.changed();
  protocol::NodesVisibility state{
      .hidden = core_.nodes.hidden(), .isolated = core_.nodes.isolated(), .rev = core_.rev};
  if (changed) {
    core_.notify_others_latest<protocol::notifications::nodes_changed>(
        by, {.hidden = state.hidden, .isolated = state.isolated, .rev = core_.rev, .by = by});
  }
  return state;
}

Result<protocol::Selection> SessionNodes::selection() const {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> loaded = core_.require_scene(); !loaded) return loaded.error();
  return protocol::Selection{.nodes = core_.nodes.selected(), .rev = core_.rev};
}

Result<protocol::Selection> SessionNodes::select(const protocol::NodeIds& request,
                                                 const std::string& by) {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> known = check(request.nodes); !known) return known.error();
  if (core_.nodes.select(request.nodes)) {
    core_.changed();
    core_.notify_others_latest<protocol::notifications::selection_changed>(
        by, {.nodes = core_.nodes.selected(), .rev = core_.rev, .by = by});
  }
  return protocol::Selection{.nodes = core_.nodes.selected(), .rev = core_.rev};
}

}  // namespace heliograph::session
