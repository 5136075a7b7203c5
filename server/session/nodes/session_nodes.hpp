#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "session/state/session_core.hpp"

namespace heliograph::session {

/// Commands on the nodes of a session's scene. Thread safe. `by` is the viewer that asks, empty for
/// a caller without a stream.
class SessionNodes {
 public:
  explicit SessionNodes(SessionCore& core) : core_(core) {}

  protocol::Result<protocol::NodeList> list(const protocol::NodesList& request) const;
  protocol::Result<protocol::NodeProperties> properties(const protocol::NodeIds& request) const;
  protocol::Result<protocol::NodesVisibility> patch(const protocol::NodesPatch& request,
                                                    const std::string& by);
  protocol::Result<protocol::NodesVisibility> isolate(const protocol::NodeIds& request,
                                                      const std::string& by);
  protocol::Result<protocol::Selection> selection() const;
  protocol::Result<protocol::Selection> select(const protocol::NodeIds& request,
                                               const std::string& by);

 private:
  protocol::Result<void> check(const std::vector<std::uint32_t>& nodes) const;
  protocol::NodesVisibility publish_visibility(bool changed, const std::string& by);

  SessionCore& core_;
};

}  // namespace heliograph::session
