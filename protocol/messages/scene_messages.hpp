#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "protocol/json/fields.hpp"
#include "protocol/messages/kinds.hpp"
#include "protocol/messages/session_messages.hpp"

// Messages about what is in a scene: its lights, materials and environment, and what of it lies
// under a point of the picture. Changes are a session's own.

namespace heliograph::protocol {

struct LightInfo {
  std::string name;
  LightType type = LightType::directional;
  bool enabled = true;
  Vec3 color{1.0f, 1.0f, 1.0f};
  float intensity = 0.0f;
  std::optional<Vec3> position;
  std::optional<Vec3> direction;
  std::optional<float> range;
  std::optional<float> radius;
  std::optional<float> angular_diameter;
  std::optional<float> width;
  std::optional<float> height;
  std::vector<std::string> changed;

  static constexpr auto fields() {
    return std::tuple{
        field("name", &LightInfo::name, "Name for lights.patch, different for every light."),
        field("type", &LightInfo::type, "What kind of light it is."),
        field("enabled", &LightInfo::enabled, "Whether it shines."),
        field("color", &LightInfo::color, "Linear colour."),
        field("intensity", &LightInfo::intensity,
              "Factor on the colour: lux (directional), candela (point, spot) or radiance "
              "(rectangle, disk)."),
        field("position", &LightInfo::position, "Its middle, world space; not of directional.")
            .unit("metres"),
        field("direction", &LightInfo::direction,
              "The way its light travels, world space; not of point lights."),
        field("range", &LightInfo::range,
              "How far a point or spot light reaches; 0: without limit.")
            .unit("metres"),
        field("radius", &LightInfo::radius, "Of point, spot and disk lights.").unit("metres"),
        field("angular_diameter", &LightInfo::angular_diameter,
              "Apparent size of a directional light.")
            .unit("degrees"),
        field("width", &LightInfo::width, "Of a rectangle.").unit("metres"),
        field("height", &LightInfo::height, "Of a rectangle.").unit("metres"),
        field("changed", &LightInfo::changed, "Members that differ from the scene's file."),
    };
  }
  bool operator==(const LightInfo&) const = default;
};

struct LightList {
  std::vector<LightInfo> lights;
  std::uint32_t rev = 0;

  static constexpr auto fields() {
    return std::tuple{
        field("lights", &LightList::lights, "The lights of the scene as they are now."),
        field("rev", &LightList::rev, "Revision of the session's state."),
    };
  }
  bool operator==(const LightList&) const = default;
};

struct LightPatch {
  static constexpr bool strict = true;
  Change<bool> enabled;
  Change<Vec3> color;
  Change<float> intensity;
  Change<Vec3> position;
  Change<Vec3> direction;
  Change<float> range;
  Change<float> radius;
  Change<float> angular_diameter;
  Change<float> width;
  Change<float> height;

  static constexpr auto fields() {
    return std::tuple{
        field("enabled", &LightPatch::enabled, "Whether it shines."),
        field("color", &LightPatch::color, "Linear colour.").range(0, 1e6),
        field("intensity", &LightPatch::intensity, "Factor on the colour.").range(0, 1e9),
        field("position", &LightPatch::position, "Its middle, world space.")
            .range(-1e9, 1e9)
            .unit("metres"),
        field("direction", &LightPatch::direction,
              "The way its light travels, world space; any length but 0.")
            .range(-1e9, 1e9),
        field("range", &LightPatch::range, "How far it reaches; 0: without limit.")
            .range(0, 1e9)
            .unit("metres"),
        field("radius", &LightPatch::radius, "Larger lights cast softer shadows.")
            .range(0, 1e6)
            .unit("metres"),
        field("angular_diameter", &LightPatch::angular_diameter,
              "Larger lights cast softer shadows; the sun's is 0.53.")
            .range(0, 90)
            .unit("degrees"),
        field("width", &LightPatch::width, "Of a rectangle.").range(1e-6, 1e6).unit("metres"),
        field("height", &LightPatch::height, "Of a rectangle.").range(1e-6, 1e6).unit("metres"),
    };
  }
  bool operator==(const LightPatch&) const = default;
};

struct LightsPatch {
  std::string light;
  LightPatch patch;

  static constexpr auto fields() {
    return std::tuple{
        field("light", &LightsPatch::light, "A name that lights.list gave.").length(1, 256),
        field("patch", &LightsPatch::patch,
              "What shall change (RFC 7386): null brings back what the scene's file says."),
    };
  }
  bool operator==(const LightsPatch&) const = default;
};

struct LightState {
  LightInfo light;
  std::uint32_t rev = 0;

  static constexpr auto fields() {
    return std::tuple{
        field("light", &LightState::light, "The light as it is now."),
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
        field("light", &LightsChanged::light, "The light as it is now."),
        field("rev", &LightsChanged::rev, "Revision of the session's state."),
        field("by", &LightsChanged::by, "The viewer that changed it; empty: the server."),
    };
  }
  bool operator==(const LightsChanged&) const = default;
};

struct MaterialInfo {
  std::string name;
  Vec3 base_color{};
  float roughness = 0.0f;
  float metallic = 0.0f;
  Vec3 emissive{};
  float normal_scale = 1.0f;
  float occlusion_strength = 1.0f;
  std::vector<std::string> textures;
  std::vector<std::string> changed;

  static constexpr auto fields() {
    return std::tuple{
        field("name", &MaterialInfo::name, "Name for materials.patch, different for every one."),
        field("base_color", &MaterialInfo::base_color, "Linear factor on the texture, if any."),
        field("roughness", &MaterialInfo::roughness,
              "Perceptual roughness, factor on the texture, if any."),
        field("metallic", &MaterialInfo::metallic, "Metalness, factor on the texture, if any."),
        field("emissive", &MaterialInfo::emissive,
              "Linear radiance given off, factor on the texture, if any."),
        field("normal_scale", &MaterialInfo::normal_scale, "How deep the normal texture goes."),
        field("occlusion_strength", &MaterialInfo::occlusion_strength,
              "How dark the occlusion texture gets."),
        field("textures", &MaterialInfo::textures, "Which values have a texture."),
        field("changed", &MaterialInfo::changed, "Members that differ from the scene's file."),
    };
  }
  bool operator==(const MaterialInfo&) const = default;
};

struct MaterialList {
  std::vector<MaterialInfo> materials;
  std::uint32_t rev = 0;

  static constexpr auto fields() {
    return std::tuple{
        field("materials", &MaterialList::materials, "The materials of the scene as they are now."),
        field("rev", &MaterialList::rev, "Revision of the session's state."),
    };
  }
  bool operator==(const MaterialList&) const = default;
};

struct MaterialPatch {
  static constexpr bool strict = true;
  Change<Vec3> base_color;
  Change<float> roughness;
  Change<float> metallic;
  Change<Vec3> emissive;
  Change<float> normal_scale;
  Change<float> occlusion_strength;

  static constexpr auto fields() {
    return std::tuple{
        field("base_color", &MaterialPatch::base_color, "Linear factor.").range(0, 1),
        field("roughness", &MaterialPatch::roughness, "Perceptual roughness.").range(0, 1),
        field("metallic", &MaterialPatch::metallic, "Metalness.").range(0, 1),
        field("emissive", &MaterialPatch::emissive, "Linear radiance given off.").range(0, 1e6),
        field("normal_scale", &MaterialPatch::normal_scale, "How deep the normal texture goes.")
            .range(0, 16),
        field("occlusion_strength", &MaterialPatch::occlusion_strength,
              "How dark the occlusion texture gets.")
            .range(0, 1),
    };
  }
  bool operator==(const MaterialPatch&) const = default;
};

struct MaterialsPatch {
  std::string material;
  MaterialPatch patch;

  static constexpr auto fields() {
    return std::tuple{
        field("material", &MaterialsPatch::material, "A name that materials.list gave.")
            .length(1, 256),
        field("patch", &MaterialsPatch::patch,
              "What shall change (RFC 7386): null brings back what the scene's file says."),
    };
  }
  bool operator==(const MaterialsPatch&) const = default;
};

struct MaterialState {
  MaterialInfo material;
  std::uint32_t rev = 0;

  static constexpr auto fields() {
    return std::tuple{
        field("material", &MaterialState::material, "The material as it is now."),
        field("rev", &MaterialState::rev, "Revision of the session's state."),
    };
  }
  bool operator==(const MaterialState&) const = default;
};

struct MaterialsChanged {
  MaterialInfo material;
  std::uint32_t rev = 0;
  std::string by;

  static constexpr auto fields() {
    return std::tuple{
        field("material", &MaterialsChanged::material, "The material as it is now."),
        field("rev", &MaterialsChanged::rev, "Revision of the session's state."),
        field("by", &MaterialsChanged::by, "The viewer that changed it; empty: the server."),
    };
  }
  bool operator==(const MaterialsChanged&) const = default;
};

struct EnvironmentFile {
  std::string name;
  std::uint64_t bytes = 0;

  static constexpr auto fields() {
    return std::tuple{
        field("name", &EnvironmentFile::name, "Name for environment.set."),
        field("bytes", &EnvironmentFile::bytes, "Size of the file.").unit("bytes"),
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
              "The one that was chosen; null: the one that goes with the scene.")
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
        field("name", &EnvironmentSet::name,
              "A name that environment.list gave; null: the one that goes with the scene.")
            .length(1, 512),
        field("rotation", &EnvironmentSet::rotation, "Sets environment.rotation, too.")
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
              "The one that was chosen; null: the one that goes with the scene.")
            .or_null(),
        field("rev", &EnvironmentChanged::rev, "Revision of the session's state."),
        field("by", &EnvironmentChanged::by, "The viewer that chose it; empty: the server."),
    };
  }
  bool operator==(const EnvironmentChanged&) const = default;
};

/// Where in the picture.
struct PicturePoint {
  float x = 0.0f;
  float y = 0.0f;

  static constexpr auto fields() {
    return std::tuple{
        field("x", &PicturePoint::x, "Share of the picture's width, from the left.").range(0, 1),
        field("y", &PicturePoint::y, "Share of the picture's height, from the top.").range(0, 1),
    };
  }
  bool operator==(const PicturePoint&) const = default;
};

struct PickResult {
  bool hit = false;
  std::optional<Vec3> position;
  std::optional<Vec3> normal;
  std::optional<float> distance;
  std::optional<std::string> object;
  std::optional<std::string> material;

  static constexpr auto fields() {
    return std::tuple{
        field("hit", &PickResult::hit, "Whether there is a surface; the rest is null if not."),
        field("position", &PickResult::position, "The point on it, world space.")
            .unit("metres")
            .or_null(),
        field("normal", &PickResult::normal, "Of its triangle, toward the camera, world space.")
            .or_null(),
        field("distance", &PickResult::distance, "From the camera.").unit("metres").or_null(),
        field("object", &PickResult::object, "Name of its node, else of its mesh.").or_null(),
        field("material", &PickResult::material, "Name for materials.patch.").or_null(),
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
        field("name", &BufferValue::name, "The buffer."),
        field("value", &BufferValue::value,
              "Its channels there, which frame.buffers explains; null is no finite number."),
        field("unit", &BufferValue::unit, "Of the values; empty: plain numbers."),
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
        field("column", &Inspection::column, "The pixel that was read, from the left."),
        field("row", &Inspection::row, "And from the top."),
        field("width", &Inspection::width, "Of the picture it was read from.").unit("pixels"),
        field("height", &Inspection::height, "Of the picture it was read from.").unit("pixels"),
        field("buffers", &Inspection::buffers, "Every buffer's value at that pixel."),
    };
  }
  bool operator==(const Inspection&) const = default;
};

/// The camera about its target.
struct CameraOrbit {
  std::optional<float> yaw;
  std::optional<float> pitch;
  std::optional<float> distance;
  std::optional<float> dolly;
  std::optional<std::uint32_t> seq;

  static constexpr auto fields() {
    return std::tuple{
        field("yaw", &CameraOrbit::yaw,
              "Turns about the up axis, counter-clockwise seen from above.")
            .range(-360, 360)
            .unit("degrees"),
        field("pitch", &CameraOrbit::pitch,
              "Raises the camera, lowers it below 0; it stops short of straight above and below.")
            .range(-180, 180)
            .unit("degrees"),
        field("distance", &CameraOrbit::distance, "How far from the target to be.")
            .range(1e-6, 1e9)
            .unit("metres"),
        field("dolly", &CameraOrbit::dolly, "Factor on the distance: below 1 comes closer.")
            .range(0.001, 1000),
        field("seq", &CameraOrbit::seq,
              "The client's own count; frames that show this camera echo it as input_seq_echo."),
    };
  }
  bool operator==(const CameraOrbit&) const = default;
};

}  // namespace heliograph::protocol
