#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "protocol/json/fields.hpp"
#include "protocol/messages/kinds.hpp"
#include "protocol/messages/session_messages.hpp"

// Messages about the content of a scene: lights, environment, and the surface or buffer values at a
// point of the image. Edits belong to one session.

namespace heliograph::protocol {

struct LightInfo {
  std::string name;
  LightType type = LightType::directional;
  bool enabled = true;
  Vec3 color{1.0f, 1.0f, 1.0f};
  std::optional<float> temperature;
  float intensity = 0.0f;
  std::optional<Vec3> position;
  std::optional<Vec3> direction;
  std::optional<float> range;
  std::optional<float> radius;
  std::optional<float> angular_diameter;
  std::optional<float> width;
  std::optional<float> height;
  std::optional<float> inner_cone;
  std::optional<float> outer_cone;
  bool added = false;
  std::vector<std::string> changed;

  static constexpr auto fields() {
    return std::tuple{
        field("name", &LightInfo::name, "Unique name for lights.patch."),
        field("type", &LightInfo::type, "Type of the light."),
        field("enabled", &LightInfo::enabled, "Whether the light is on."),
        field("color", &LightInfo::color, "Linear colour."),
        field("temperature", &LightInfo::temperature,
              "Temperature of the black body that gives the colour; absent: it is no such colour.")
            .unit("kelvin"),
        field("intensity", &LightInfo::intensity,
              "Factor on the colour: lux (directional), candela (point, spot) or radiance "
              "(rectangle, disk)."),
        field("position", &LightInfo::position,
              "Centre, world space; absent for directional lights.")
            .unit("metres"),
        field("direction", &LightInfo::direction,
              "Direction of the light rays, world space; absent for point lights."),
        field("range", &LightInfo::range, "Range of point and spot lights; 0: unlimited.")
            .unit("metres"),
        field("radius", &LightInfo::radius, "Radius of point, spot and disk lights.")
            .unit("metres"),
        field("angular_diameter", &LightInfo::angular_diameter,
              "Apparent diameter of a directional light.")
            .unit("degrees"),
        field("width", &LightInfo::width, "Width of a rectangle.").unit("metres"),
        field("height", &LightInfo::height, "Height of a rectangle.").unit("metres"),
        field("inner_cone", &LightInfo::inner_cone,
              "Angle from the axis at which a spot light begins to fade.")
            .unit("degrees"),
        field("outer_cone", &LightInfo::outer_cone, "Angle from the axis at which it ends.")
            .unit("degrees"),
        field("added", &LightInfo::added, "Whether the session has added it; see lights.add."),
        field("changed", &LightInfo::changed, "Members that differ from the scene file."),
    };
  }
  bool operator==(const LightInfo&) const = default;
};

struct LightList {
  std::vector<LightInfo> lights;
  std::uint32_t rev = 0;

  static constexpr auto fields() {
    return std::tuple{
        field("lights", &LightList::lights, "The lights of the scene with the session's edits."),
        field("rev", &LightList::rev, "Revision of the session's state."),
    };
  }
  bool operator==(const LightList&) const = default;
};

struct LightPatch {
  static constexpr bool strict = true;
  Change<bool> enabled;
  Change<Vec3> color;
  Change<float> temperature;
  Change<float> intensity;
  Change<Vec3> position;
  Change<Vec3> direction;
  Change<float> range;
  Change<float> radius;
  Change<float> angular_diameter;
  Change<float> width;
  Change<float> height;
  Change<float> inner_cone;
  Change<float> outer_cone;

  static constexpr auto fields() {
    return std::tuple{
        field("enabled", &LightPatch::enabled, "Whether the light is on."),
        field("color", &LightPatch::color, "Linear colour; it ends a temperature.").range(0, 1e6),
        field("temperature", &LightPatch::temperature,
              "Gives the light the colour of a black body; takes precedence over color.")
            .range(min_temperature, max_temperature)
            .unit("kelvin"),
        field("intensity", &LightPatch::intensity, "Factor on the colour.").range(0, 1e9),
        field("position", &LightPatch::position, "Centre, world space.")
            .range(-max_coordinate, max_coordinate)
            .unit("metres"),
        field("direction", &LightPatch::direction,
              "Direction of the light rays, world space; any length except 0.")
            .range(-max_coordinate, max_coordinate),
        field("range", &LightPatch::range, "Range; 0: unlimited.").range(0, 1e9).unit("metres"),
        field("radius", &LightPatch::radius, "Radius: larger lights cast softer shadows.")
            .range(0, 1e6)
            .unit("metres"),
        field("angular_diameter", &LightPatch::angular_diameter,
              "Apparent diameter: larger lights cast softer shadows; the sun's is 0.53.")
            .range(0, 90)
            .unit("degrees"),
        field("width", &LightPatch::width, "Width of a rectangle.").range(1e-6, 1e6).unit("metres"),
        field("height", &LightPatch::height, "Height of a rectangle.")
            .range(1e-6, 1e6)
            .unit("metres"),
        field("inner_cone", &LightPatch::inner_cone,
              "Angle from the axis at which a spot light begins to fade; below outer_cone.")
            .range(0, 90)
            .unit("degrees"),
        field("outer_cone", &LightPatch::outer_cone, "Angle from the axis at which it ends.")
            .range(0.01, 90)
            .unit("degrees"),
    };
  }
  bool operator==(const LightPatch&) const = default;
};

struct LightsPatch {
  std::string light;
  LightPatch patch;

  static constexpr auto fields() {
    return std::tuple{
        field("light", &LightsPatch::light, "A name from lights.list.").length(1, max_node_name),
        field("patch", &LightsPatch::patch,
              "A merge patch (RFC 7386); null restores the value of the scene file."),
    };
  }
  bool operator==(const LightsPatch&) const = default;
};

struct LightState {
  LightInfo light;
  std::uint32_t rev = 0;

  static constexpr auto fields() {
    return std::tuple{
        field("light", &LightState::light, "The light after the change."),
        field("rev", &LightState::rev, "Revision of the session's state."),
    };
  }
  bool operator==(const LightState&) const = default;
};

struct LightsChanged {
  LightInfo light;
  std::uint32_t rev = 0;
  std::string by;

  static constexpr auto fields() {
    return std::tuple{
        field("light", &LightsChanged::light, "The light after the change."),
        field("rev", &LightsChanged::rev, "Revision of the session's state."),
        field("by", &LightsChanged::by, "The viewer that changed it; empty: the server."),
    };
  }
  bool operator==(const LightsChanged&) const = default;
};

struct EnvironmentFile {
  std::string name;
  std::uint64_t bytes = 0;
  bool uploaded = false;

  static constexpr auto fields() {
    return std::tuple{
        field("name", &EnvironmentFile::name, "Name for environment.set."),
        field("bytes", &EnvironmentFile::bytes, "Size of the file.").unit("bytes"),
        field("uploaded", &EnvironmentFile::uploaded,
              "Whether it was uploaded: then DELETE /api/v1/environments/NAME deletes it."),
    };
  }
  bool operator==(const EnvironmentFile&) const = default;
};

struct EnvironmentState {
  std::vector<EnvironmentFile> environments;
  std::optional<std::string> current;
  float rotation = 0.0f;
  float intensity = 1.0f;
  std::uint32_t rev = 0;

  static constexpr auto fields() {
    return std::tuple{
        field("environments", &EnvironmentState::environments,
              "The environments of the server's catalogue."),
        field("current", &EnvironmentState::current,
              "The chosen environment; null: the scene's own.")
            .or_null(),
        field("rotation", &EnvironmentState::rotation, "The setting environment.rotation.")
            .unit("degrees"),
        field("intensity", &EnvironmentState::intensity, "The setting environment.intensity."),
        field("rev", &EnvironmentState::rev, "Revision of the session's state."),
    };
  }
  bool operator==(const EnvironmentState&) const = default;
};

struct EnvironmentSet {
  Change<std::string> name;
  std::optional<float> rotation;

  static constexpr auto fields() {
    return std::tuple{
        field("name", &EnvironmentSet::name, "A name from environment.list; null: the scene's own.")
            .length(1, max_scene_name),
        field("rotation", &EnvironmentSet::rotation, "Also sets environment.rotation.")
            .range(-180, 180)
            .unit("degrees"),
    };
  }
  bool operator==(const EnvironmentSet&) const = default;
};

struct EnvironmentChanged {
  std::optional<std::string> current;
  std::uint32_t rev = 0;
  std::string by;

  static constexpr auto fields() {
    return std::tuple{
        field("current", &EnvironmentChanged::current,
              "The chosen environment; null: the scene's own.")
            .or_null(),
        field("rev", &EnvironmentChanged::rev, "Revision of the session's state."),
        field("by", &EnvironmentChanged::by, "The viewer that chose it; empty: the server."),
    };
  }
  bool operator==(const EnvironmentChanged&) const = default;
};

/// A point of the image.
struct ImagePoint {
  float x = 0.0f;
  float y = 0.0f;

  static constexpr auto fields() {
    return std::tuple{
        field("x", &ImagePoint::x, "Fraction of the image width, from the left.").range(0, 1),
        field("y", &ImagePoint::y, "Fraction of the image height, from the top.").range(0, 1),
    };
  }
  bool operator==(const ImagePoint&) const = default;
};

struct PickResult {
  bool hit = false;
  std::optional<Vec3> position;
  std::optional<Vec3> normal;
  std::optional<float> distance;
  std::optional<std::string> object;
  std::optional<std::string> material;
  std::optional<std::uint32_t> node;

  static constexpr auto fields() {
    return std::tuple{
        field("hit", &PickResult::hit,
              "Whether there is a surface; if not, the other members are null."),
        field("position", &PickResult::position, "Position on the surface, world space.")
            .unit("metres")
            .or_null(),
        field("normal", &PickResult::normal, "Geometric normal, facing the camera, world space.")
            .or_null(),
        field("distance", &PickResult::distance, "Distance from the camera.")
            .unit("metres")
            .or_null(),
        field("object", &PickResult::object, "Name of the node, otherwise of the mesh.").or_null(),
        field("material", &PickResult::material, "Name for materials.patch.").or_null(),
        field("node", &PickResult::node, "Id of the node, as nodes.list has it.").or_null(),
    };
  }
  bool operator==(const PickResult&) const = default;
};

struct BufferValue {
  std::string name;
  std::vector<std::optional<float>> value;
  std::string unit;

  static constexpr auto fields() {
    return std::tuple{
        field("name", &BufferValue::name, "Name of the buffer."),
        field("value", &BufferValue::value,
              "Values of its channels, which frame.buffers describes; null: not finite."),
        field("unit", &BufferValue::unit, "Unit of the values; empty: dimensionless."),
    };
  }
  bool operator==(const BufferValue&) const = default;
};

struct Inspection {
  std::uint32_t column = 0;
  std::uint32_t row = 0;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<BufferValue> buffers;

  static constexpr auto fields() {
    return std::tuple{
        field("column", &Inspection::column, "Column of the pixel, from the left."),
        field("row", &Inspection::row, "Row of the pixel, from the top."),
        field("width", &Inspection::width, "Width of the image.").unit("pixels"),
        field("height", &Inspection::height, "Height of the image.").unit("pixels"),
        field("buffers", &Inspection::buffers, "The value of every buffer at that pixel."),
    };
  }
  bool operator==(const Inspection&) const = default;
};

/// An orbit of the camera around its target.
struct CameraOrbit {
  std::optional<float> yaw;
  std::optional<float> pitch;
  std::optional<float> distance;
  std::optional<float> dolly;
  std::optional<std::uint32_t> seq;
  std::optional<std::uint32_t> scene_rev;

  static constexpr auto fields() {
    return std::tuple{
        field("yaw", &CameraOrbit::yaw,
              "Rotation about the up axis, counter-clockwise seen from above.")
            .range(-360, 360)
            .unit("degrees"),
        field("pitch", &CameraOrbit::pitch,
              "Positive raises the camera, negative lowers it; it stops short of the poles.")
            .range(-180, 180)
            .unit("degrees"),
        field("distance", &CameraOrbit::distance, "New distance to the target.")
            .range(1e-6, 1e9)
            .unit("metres"),
        field("dolly", &CameraOrbit::dolly, "Factor on the distance: below 1 moves closer.")
            .range(0.001, 1000),
        field("seq", &CameraOrbit::seq,
              "The client's sequence number; frames that show this camera echo it as "
              "input_seq_echo."),
        field("scene_rev", &CameraOrbit::scene_rev,
              "That of the camera from which the movement began, as in camera.set."),
    };
  }
  bool operator==(const CameraOrbit&) const = default;
};

}  // namespace heliograph::protocol
