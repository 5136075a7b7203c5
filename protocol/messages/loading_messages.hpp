#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "protocol/json/fields.hpp"
#include "protocol/messages/animation_messages.hpp"
#include "protocol/messages/edit_messages.hpp"
#include "protocol/messages/kinds.hpp"
#include "protocol/messages/session_messages.hpp"

// Messages about scenes: the catalogue, loading, the loaded scene.

namespace heliograph::protocol {

struct SceneFile {
  std::string name;
  std::uint64_t bytes = 0;
  bool uploaded = false;

  static constexpr auto fields() {
    return std::tuple{
        field("name", &SceneFile::name, "Name for scene.load."),
        field("bytes", &SceneFile::bytes, "Size of the file.").unit("bytes"),
        field("uploaded", &SceneFile::uploaded,
              "Whether it was uploaded: then DELETE /api/v1/scenes/NAME deletes it."),
    };
  }
  bool operator==(const SceneFile&) const = default;
};

struct SceneListResult {
  std::vector<SceneFile> scenes;
  std::optional<std::string> current;

  static constexpr auto fields() {
    return std::tuple{
        field("scenes", &SceneListResult::scenes, "The scenes of the server's catalogue."),
        field("current", &SceneListResult::current, "Name of the loaded scene, or null.").or_null(),
    };
  }
  bool operator==(const SceneListResult&) const = default;
};

struct SceneLoad {
  std::string name;
  std::optional<std::string> scene;
  std::optional<std::string> variant;
  std::optional<EditDocument> edits;

  static constexpr auto fields() {
    return std::tuple{
        field("name", &SceneLoad::name, "A name from scene.list.").length(1, max_scene_name),
        field("scene", &SceneLoad::scene,
              "The scene to load from a file with several: its name, or its index from 0. Absent: "
              "the file's default.")
            .length(1, max_node_name),
        field("variant", &SceneLoad::variant,
              "Material variant of the file to apply. Absent: the default materials.")
            .length(1, max_node_name),
        field("edits", &SceneLoad::edits,
              "A document that edits.get returned, applied as by edits.apply."),
    };
  }
  bool operator==(const SceneLoad&) const = default;
};

struct SceneCancelled {
  bool cancelled = false;

  static constexpr auto fields() {
    return std::tuple{
        field("cancelled", &SceneCancelled::cancelled,
              "Whether a load was cancelled; its scene.load returns an error."),
    };
  }
  bool operator==(const SceneCancelled&) const = default;
};

struct UploadsChanged {
  UploadKind kind = UploadKind::scene;
  std::string name;
  bool deleted = false;

  static constexpr auto fields() {
    return std::tuple{
        field("kind", &UploadsChanged::kind, "What the file is."),
        field("name", &UploadsChanged::name, "Its name."),
        field("deleted", &UploadsChanged::deleted, "Whether it was deleted; else uploaded."),
    };
  }
  bool operator==(const UploadsChanged&) const = default;
};

struct Bounds {
  Vec3 min{};
  Vec3 max{};

  static constexpr auto fields() {
    return std::tuple{
        field("min", &Bounds::min, "Minimum corner, world space.").unit("metres"),
        field("max", &Bounds::max, "Maximum corner, world space.").unit("metres"),
    };
  }
  bool operator==(const Bounds&) const = default;
};

/// Memory use of a loaded scene.
struct SceneMemory {
  std::uint64_t file = 0;
  std::uint64_t host = 0;
  std::uint64_t device = 0;

  static constexpr auto fields() {
    return std::tuple{
        field("file", &SceneMemory::file, "The files on disk.").unit("bytes"),
        field("host", &SceneMemory::host, "Geometry, animations and tables in the server's memory.")
            .unit("bytes"),
        field("device", &SceneMemory::device,
              "Tables, textures and acceleration structures on the device.")
            .unit("bytes"),
    };
  }
  bool operator==(const SceneMemory&) const = default;
};

struct SceneInfo {
  std::string name;
  std::uint64_t triangles = 0;
  std::uint32_t instances = 0;
  std::uint32_t meshes = 0;
  std::uint32_t materials = 0;
  std::uint32_t textures = 0;
  std::uint32_t lights = 0;
  std::uint64_t vertices = 0;
  std::uint32_t nodes = 0;
  std::uint32_t images = 0;
  std::uint64_t texels = 0;
  std::uint32_t deforming = 0;
  std::vector<std::string> material_names;
  std::vector<std::string> light_names;
  std::optional<std::string> environment;
  std::vector<std::string> cameras;
  std::vector<ClipInfo> clips;
  std::vector<std::string> scenes;
  std::uint32_t scene = 0;
  std::vector<std::string> variants;
  std::optional<std::string> variant;
  Bounds bounds;
  SceneMemory memory;
  std::vector<std::string> warnings;

  static constexpr auto fields() {
    return std::tuple{
        field("name", &SceneInfo::name, "Name in the catalogue."),
        field("triangles", &SceneInfo::triangles, "Triangles over all instances."),
        field("instances", &SceneInfo::instances, "Instances of meshes."),
        field("meshes", &SceneInfo::meshes, "Unique meshes."),
        field("materials", &SceneInfo::materials, "Materials."),
        field("textures", &SceneInfo::textures, "Textures."),
        field("lights", &SceneInfo::lights, "Punctual and directional lights."),
        field("vertices", &SceneInfo::vertices, "Vertices of the unique meshes."),
        field("nodes", &SceneInfo::nodes, "Nodes of the scene's hierarchy."),
        field("images", &SceneInfo::images, "Unique images that textures use."),
        field("texels", &SceneInfo::texels, "Texels of the images at full size."),
        field("deforming", &SceneInfo::deforming, "Meshes with skinning or morph targets."),
        field("material_names", &SceneInfo::material_names, "Names of the materials."),
        field("light_names", &SceneInfo::light_names, "Names of the lights."),
        field("environment", &SceneInfo::environment,
              "File of the scene's own environment; null: constant white.")
            .or_null(),
        field("cameras", &SceneInfo::cameras, "Names for camera.set."),
        field("clips", &SceneInfo::clips, "Animation clips for animation.play."),
        field("scenes", &SceneInfo::scenes, "Names of the file's scenes; a name may be empty."),
        field("scene", &SceneInfo::scene, "Index of the loaded scene in `scenes`."),
        field("variants", &SceneInfo::variants, "Names of the file's material variants."),
        field("variant", &SceneInfo::variant,
              "The applied material variant; null: the default materials.")
            .or_null(),
        field("bounds", &SceneInfo::bounds, "Bounding box of the scene."),
        field("memory", &SceneInfo::memory, "Memory use of the scene."),
        field("warnings", &SceneInfo::warnings,
              "What the importer skipped, approximated or repaired."),
    };
  }
  bool operator==(const SceneInfo&) const = default;
};

struct SceneProgress {
  std::string name;
  std::string stage;
  double fraction = 0.0;
  bool first_view = false;
  std::string by;

  static constexpr auto fields() {
    return std::tuple{
        field("name", &SceneProgress::name, "The scene that is being loaded."),
        field("stage", &SceneProgress::stage,
              "Stage of loading; ready, cancelled or failed at its end."),
        field("fraction", &SceneProgress::fraction, "Fraction of the work that is done.")
            .range(0, 1),
        field("first_view", &SceneProgress::first_view,
              "Whether frames show the scene already, without its textures."),
        field("by", &SceneProgress::by, "The viewer that loads it; empty: the server."),
    };
  }
  bool operator==(const SceneProgress&) const = default;
};

struct SceneChanged {
  SceneInfo scene;
  std::string by;

  static constexpr auto fields() {
    return std::tuple{
        field("scene", &SceneChanged::scene, "The scene that was loaded."),
        field("by", &SceneChanged::by, "The viewer that loaded it; empty: the server."),
    };
  }
  bool operator==(const SceneChanged&) const = default;
};

struct SceneUnloaded {
  std::string name;
  std::string by;

  static constexpr auto fields() {
    return std::tuple{
        field("name", &SceneUnloaded::name, "The scene that was unloaded."),
        field("by", &SceneUnloaded::by, "The viewer that unloaded it; empty: the server."),
    };
  }
  bool operator==(const SceneUnloaded&) const = default;
};

}  // namespace heliograph::protocol
