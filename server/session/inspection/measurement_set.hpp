#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "protocol/messages/measurement_messages.hpp"
#include "protocol/result.hpp"
#include "scene/surface/surface_anchor.hpp"
#include "session/inspection/marks.hpp"
#include "session/nodes/node_state.hpp"

namespace heliograph::session {

/// What is measured in a session, by scene. A refused request changes nothing. Copies share their
/// entries. Not thread safe.
class MeasurementSet {
 public:
  /// `scene` is what `part` names, `nodes` are its.
  protocol::Result<void> add(const ScenePart& part, const scene::Scene& scene,
                             const NodeState& nodes, const protocol::MeasurementAdd& request);
  protocol::Result<void> remove(const ScenePart& part, std::uint32_t id) {
    return marks_.remove(part, id);
  }
  void clear(const ScenePart& part) { marks_.clear(part); }
  void set_unit(protocol::LengthUnit unit);

  /// Values and places in a pose of the scene. What no longer fits a file that was changed is left
  /// out.
  protocol::MeasurementList list(const ScenePart& part, const scene::Scene& scene,
                                 const scene::Pose& pose) const;

 private:
  struct Point {
    glm::vec3 position{0.0f};  // without an anchor
    std::optional<scene::SurfaceAnchor> anchor;
    std::optional<protocol::SurfaceAnchor> surface;  // the same, as the protocol has it
  };
  struct Entry {
    ScenePart part;
    std::uint32_t id = 0;
    protocol::MeasurementKind kind = protocol::MeasurementKind::distance;
    std::vector<Point> points;
    std::vector<std::uint32_t> nodes;
    scene::Bounds bounds;  // of a size
  };

  protocol::Measurement describe(const Entry& entry, const scene::Scene& scene,
                                 const scene::Pose& pose) const;

  Marks<Entry> marks_{{.article = "a", .name = "measurement", .most = protocol::max_measurements}};
  protocol::LengthUnit unit_ = protocol::LengthUnit::m;
};

}  // namespace heliograph::session
