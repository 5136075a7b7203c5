#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "protocol/json/fields.hpp"
#include "protocol/limits.hpp"
#include "protocol/messages/loading_messages.hpp"
#include "protocol/messages/scene_messages.hpp"
#include "protocol/messages/surface_kinds.hpp"

// Messages about points on surfaces and what is measured between them.

namespace heliograph::protocol {

HELIOGRAPH_ENUM(MeasurementKind, distance, angle, size)
HELIOGRAPH_ENUM(LengthUnit, m, cm, mm, km, in, ft)

/// A point of a triangle, which moves and deforms with it.
struct SurfaceAnchor {
  std::uint32_t node = 0;
  std::uint32_t triangle = 0;
  Vec3 barycentrics{};

  static constexpr auto fields() {
    return std::tuple{
        field("node", &SurfaceAnchor::node, "Id from nodes.list of a node with a mesh."),
        field("triangle", &SurfaceAnchor::triangle,
              "Number of the triangle among those of the node's meshes, from 0."),
        field("barycentrics", &SurfaceAnchor::barycentrics,
              "Weights of the triangle's vertices; their sum is 1.")
            .range(0, 1),
    };
  }
  bool operator==(const SurfaceAnchor&) const = default;
};

struct SceneSnap {
  float x = 0.0f;
  float y = 0.0f;
  float radius = 0.015f;
  bool vertices = true;
  bool edges = true;

  static constexpr auto fields() {
    return std::tuple{
        field("x", &SceneSnap::x, "Fraction of the image width, from the left.").range(0, 1),
        field("y", &SceneSnap::y, "Fraction of the image height, from the top.").range(0, 1),
        field("radius", &SceneSnap::radius,
              "How far from there a vertex or edge may be, as a fraction of the image height.")
            .range(0, 0.25)
            .or_default(),
        field("vertices", &SceneSnap::vertices, "Whether vertices attract; they come before edges.")
            .or_default(),
        field("edges", &SceneSnap::edges,
              "Whether edges attract, except those that divide a flat face into triangles.")
            .or_default(),
    };
  }
  bool operator==(const SceneSnap&) const = default;
};

struct SnapResult {
  bool hit = false;
  std::optional<Vec3> position;
  std::optional<Vec3> normal;
  std::optional<SurfaceFeature> feature;
  std::optional<SurfaceAnchor> surface;

  static constexpr auto fields() {
    return std::tuple{
        field("hit", &SnapResult::hit,
              "Whether there is a surface; if not, the other members are null or absent."),
        field("position", &SnapResult::position, "The point on the mesh, world space.")
            .unit("metres")
            .or_null(),
        field("normal", &SnapResult::normal, "Of the triangle, facing the camera, world space.")
            .or_null(),
        field("feature", &SnapResult::feature, "What it lies on; absent without a surface."),
        field("surface", &SnapResult::surface, "The same point, to be kept as the mesh moves.")
            .or_null(),
    };
  }
  bool operator==(const SnapResult&) const = default;
};

struct MeasuredPoint {
  std::optional<Vec3> position;
  std::optional<SurfaceAnchor> surface;

  static constexpr auto fields() {
    return std::tuple{
        field("position", &MeasuredPoint::position,
              "World space; in a request without `surface`: where the point stays.")
            .range(-max_coordinate, max_coordinate)
            .unit("metres"),
        field("surface", &MeasuredPoint::surface,
              "From scene.snap: the point stays on this triangle, whatever `position` says."),
    };
  }
  bool operator==(const MeasuredPoint&) const = default;
};

struct MeasurementAdd {
  MeasurementKind kind = MeasurementKind::distance;
  std::vector<MeasuredPoint> points;
  std::vector<std::uint32_t> nodes;
  std::optional<std::uint32_t> id;

  static constexpr auto fields() {
    return std::tuple{
        field("kind", &MeasurementAdd::kind,
              "distance: between two points; angle: of three points, at the second; size: of the "
              "box around nodes with all below them, before any animation."),
        field("points", &MeasurementAdd::points, "Of a distance or angle.")
            .length(0, 3)
            .or_default(),
        field("nodes", &MeasurementAdd::nodes, "Of a size: ids from nodes.list.")
            .length(0, max_measured_nodes)
            .or_default(),
        field("id", &MeasurementAdd::id,
              "Its id, such as that of one that was removed; absent: the next one.")
            .range(1, 1e9),
    };
  }
  bool operator==(const MeasurementAdd&) const = default;
};

struct Measurement {
  std::uint32_t id = 0;
  MeasurementKind kind = MeasurementKind::distance;
  double value = 0.0;
  std::string text;
  std::vector<MeasuredPoint> points;
  std::vector<std::uint32_t> nodes;
  std::optional<Vec3> extent;
  std::optional<Bounds> bounds;

  static constexpr auto fields() {
    return std::tuple{
        field("id", &Measurement::id, "Its id, unique in the session."),
        field("kind", &Measurement::kind, "What is measured."),
        field("value", &Measurement::value,
              "Metres; of an angle: degrees; of a size: the box's diagonal."),
        field("text", &Measurement::text, "The value in the unit, for display."),
        field("points", &Measurement::points, "Where they are now."),
        field("nodes", &Measurement::nodes, "Of a size."),
        field("extent", &Measurement::extent,
              "Along the three axes: of a distance from the first to the second point, of a size "
              "the sides of the box; null for angles.")
            .unit("metres")
            .or_null(),
        field("bounds", &Measurement::bounds, "Of a size: the box; null otherwise.").or_null(),
    };
  }
  bool operator==(const Measurement&) const = default;
};

struct MeasurementList {
  std::optional<std::string> scene;
  LengthUnit unit = LengthUnit::m;
  std::vector<Measurement> measurements;
  std::uint32_t changes = 0;

  static constexpr auto fields() {
    return std::tuple{
        field("scene", &MeasurementList::scene, "The scene that the session shows; null: none.")
            .or_null(),
        field("unit", &MeasurementList::unit, "Unit of the texts."),
        field("measurements", &MeasurementList::measurements, "In the order of their ids."),
        field("changes", &MeasurementList::changes,
              "Counts the changes of the session's measurements."),
    };
  }
  bool operator==(const MeasurementList&) const = default;
};

struct MeasurementId {
  std::uint32_t id = 0;

  static constexpr auto fields() {
    return std::tuple{field("id", &MeasurementId::id, "An id from measurements.list.")};
  }
  bool operator==(const MeasurementId&) const = default;
};

struct MeasurementUnit {
  LengthUnit unit = LengthUnit::m;

  static constexpr auto fields() {
    return std::tuple{field("unit", &MeasurementUnit::unit, "Unit of the texts from now on.")};
  }
  bool operator==(const MeasurementUnit&) const = default;
};

struct MeasurementsChanged {
  MeasurementList list;
  std::string by;

  static constexpr auto fields() {
    return std::tuple{
        field("list", &MeasurementsChanged::list, "The measurements after the change."),
        field("by", &MeasurementsChanged::by, "The viewer that changed them; empty: the server."),
    };
  }
  bool operator==(const MeasurementsChanged&) const = default;
};

}  // namespace heliograph::protocol
