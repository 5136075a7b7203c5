#include "session/inspection/measurement_set.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "session/inspection/anchors.hpp"
#include "session/inspection/measured_text.hpp"
#include "session/library/scene_description.hpp"

namespace heliograph::session {

using protocol::MeasurementKind;
using protocol::Result;
namespace error = protocol::error;

namespace {

/// Whether the request has as many points and nodes as its kind needs.
Result<void> check_shape(const protocol::MeasurementAdd& request) {
  const bool size = request.kind == MeasurementKind::size;
  const std::size_t points = size ? 0 : request.kind == MeasurementKind::angle ? 3 : 2;
  const std::string kind(protocol::enum_name(request.kind));
  if (request.points.size() != points) {
    return error::invalid("points", "do not fit the kind " + kind,
                          std::to_string(points) + " points");
  }
  if (size && request.nodes.empty()) {
    return error::invalid("nodes", "a size needs the nodes that it is of", "1 node or more");
  }
  if (!size && !request.nodes.empty()) {
    return error::invalid("nodes", "do not fit the kind " + kind, "0 nodes");
  }
  return {};
}

/// Between two directions, degrees; exact for small angles as well.
double angle_between(const glm::dvec3& a, const glm::dvec3& b) {
  return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

/// Around all vertices of the meshes of these nodes, world space, before any animation.
scene::Bounds exact_bounds(const scene::Scene& scene, const std::vector<bool>& inside) {
  const std::vector<std::uint32_t> node_of = nodes_of_instances(scene);
  const scene::Pose rest = scene::rest_pose(scene);
  scene::Bounds bounds;
  for (std::uint32_t i = 0; i < node_of.size(); ++i) {
    if (!inside[node_of[i]]) continue;
    for (const glm::vec3& position : scene::world_positions(scene, rest, i)) {
      bounds.include(position);
    }
  }
  return bounds;
}

}  // namespace

Result<void> MeasurementSet::add(const ScenePart& part, const scene::Scene& scene,
                                 const NodeState& nodes, const protocol::MeasurementAdd& request) {
  if (const Result<void> fits = check_shape(request); !fits) return fits;
  Entry entry{.part = part,
              .id = request.id.value_or(marks_.next_id()),
              .kind = request.kind,
              .points = {},
              .nodes = request.nodes,
              .bounds = {}};
  for (std::size_t i = 0; i < request.points.size(); ++i) {
    const protocol::MeasuredPoint& point = request.points[i];
    const std::string path = "points[" + std::to_string(i) + "]";
    Point added;
    if (point.surface) {
      const auto anchor = to_anchor(scene, *point.surface, path + ".surface");
      if (!anchor) return anchor.error();
      added.anchor = *anchor;
      added.surface = to_protocol(scene, *anchor);
    } else if (point.position) {
      added.position = from_protocol(*point.position);
    } else {
      return error::invalid(path, "needs a position or a surface");
    }
    entry.points.push_back(added);
  }
  if (request.kind == MeasurementKind::size) {
    if (const Result<void> known = nodes.check(request.nodes, "nodes"); !known) return known;
    entry.bounds = exact_bounds(scene, nodes.within(request.nodes));
    if (entry.bounds.empty()) return error::invalid("nodes", "have no meshes to measure");
  }
  return marks_.add(std::move(entry));
}

void MeasurementSet::set_unit(protocol::LengthUnit unit) {
  unit_ = unit;
  marks_.changed();
}

protocol::MeasurementList MeasurementSet::list(const ScenePart& part, const scene::Scene& scene,
                                               const scene::Pose& pose) const {
  protocol::MeasurementList list{
      .scene = part.name, .unit = unit_, .measurements = {}, .changes = marks_.changes()};
  for (const Entry& entry : marks_.entries()) {
    const bool fits = std::ranges::all_of(entry.points, [&](const Point& point) {
      return !point.anchor || scene::has_triangle(scene, *point.anchor);
    });
    if (entry.part == part && fits) list.measurements.push_back(describe(entry, scene, pose));
  }
  return list;
}

protocol::Measurement MeasurementSet::describe(const Entry& entry, const scene::Scene& scene,
                                               const scene::Pose& pose) const {
  protocol::Measurement described{.id = entry.id,
                                  .kind = entry.kind,
                                  .value = 0.0,
                                  .text = {},
                                  .points = {},
                                  .nodes = entry.nodes,
                                  .extent = {},
                                  .bounds = {}};
  std::vector<glm::dvec3> places;
  for (const Point& point : entry.points) {
    const glm::vec3 position =
        point.anchor ? scene::locate(scene, pose, *point.anchor).position : point.position;
    places.emplace_back(position);
    described.points.push_back({.position = to_protocol(position), .surface = point.surface});
  }
  switch (entry.kind) {
    case MeasurementKind::distance: {
      const glm::dvec3 extent = places[1] - places[0];
      described.value = glm::length(extent);
      described.text = length_text(described.value, unit_);
      described.extent = to_protocol(glm::vec3(extent));
      break;
    }
    case MeasurementKind::angle:
      described.value = angle_between(places[0] - places[1], places[2] - places[1]);
      described.text = angle_text(described.value);
      break;
    case MeasurementKind::size: {
      const glm::vec3 sides = entry.bounds.maximum - entry.bounds.minimum;
      described.value = glm::length(glm::dvec3(sides));
      described.text = size_text(sides, unit_);
      described.extent = to_protocol(sides);
      described.bounds = protocol::Bounds{.min = to_protocol(entry.bounds.minimum),
                                          .max = to_protocol(entry.bounds.maximum)};
      break;
    }
  }
  return described;
}

}  // namespace heliograph::session
