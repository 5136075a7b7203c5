#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "protocol/json/fields.hpp"
#include "protocol/messages/animation_messages.hpp"
#include "protocol/messages/session_messages.hpp"

// Messages about which scene is shown: what there is, what it takes to load one, what it is.

namespace heliograph::protocol {

struct SceneFile {
  std::string name;
  std::uint64_t bytes = 0;

  static constexpr auto fields() {
    return std::tuple{
        field("name", &SceneFile::name, "Name for scene.load."),
        field("bytes", &SceneFile::bytes, "Size of the file.").unit("bytes"),
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
        field("current", &SceneListResult::current, "Name of the loaded scene.").or_null(),
    };
  }
  bool operator==(const SceneListResult&) const = default;
};

struct SceneLoad {
  std::string name;
  std::optional<std::string> scene;
  std::optional<std::string> variant;

  static constexpr auto fields() {
    return std::tuple{
        field("name", &SceneLoad::name, "A name that scene.list gave.").length(1, 512),
        field("scene", &SceneLoad::scene,
              "Which scene of a file that holds several: its name, or its number from 0. Left out: "
              "the file's default.")
            .length(1, 256),
        field("variant", &SceneLoad::variant,
              "Which of the file's material variants. Left out: the materials outside of them.")
            .length(1, 256),
    };
  }
  bool operator==(const SceneLoad&) const = default;
};

struct SceneCancelled {
  bool cancelled = false;

  static constexpr auto fields() {
    return std::tuple{
        field("cancelled", &SceneCancelled::cancelled,
              "Whether a scene was being loaded; its scene.load is answered by an error."),
    };
  }
  bool operator==(const SceneCancelled&) const = default;
};

struct Bounds {
  Vec3 min{};
  Vec3 max{};

  static constexpr auto fields() {
    return std::tuple{
        field("min", &Bounds::min, "Least corner, world space.").unit("metres"),
        field("max", &Bounds::max, "Greatest corner, world space.").unit("metres"),
    };
  }
  bool operator==(const Bounds&) const = default;
};

/// Memory of a scene while it is loaded.
struct SceneMemory {
  std::uint64_t file = 0;
  std::uint64_t host = 0;
  std::uint64_t device = 0;

  static constexpr auto fields() {
    return std::tuple{
        field("file", &SceneMemory::file, "The files that were read.").unit("bytes"),
        field("host", &SceneMemory::host, "Geometry, animation and tables of the server.")
            .unit("bytes"),
        field("device", &SceneMemory::device,
              "Tables, textures and acceleration structure on the device.")
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
        field("instances", &SceneInfo::instances, "Meshes as placed in the scene."),
        field("meshes", &SceneInfo::meshes, "Different meshes."),
        field("materials", &SceneInfo::materials, "Materials."),
        field("textures", &SceneInfo::textures, "Textures."),
        field("lights", &SceneInfo::lights, "Punctual and directional lights."),
        field("vertices", &SceneInfo::vertices, "Vertices of the different meshes."),
        field("nodes", &SceneInfo::nodes, "Nodes of the scene's hierarchy."),
        field("images", &SceneInfo::images, "Different images that textures use."),
        field("texels", &SceneInfo::texels, "Texels of these, at full size."),
        field("deforming", &SceneInfo::deforming, "Meshes that joints or morph targets move."),
        field("material_names", &SceneInfo::material_names, "Names of the materials."),
        field("light_names", &SceneInfo::light_names, "Names of the lights."),
        field("environment", &SceneInfo::environment,
              "File of the environment that came with the scene; null: even white.")
            .or_null(),
        field("cameras", &SceneInfo::cameras, "Names for camera.set."),
        field("clips", &SceneInfo::clips, "What animation.play can play."),
        field("scenes", &SceneInfo::scenes, "Names of the file's scenes, which may be empty."),
        field("scene", &SceneInfo::scene, "Number of the one that is shown."),
        field("variants", &SceneInfo::variants, "Names of the file's material variants."),
        field("variant", &SceneInfo::variant, "The one that is shown; null: the file's default.")
            .or_null(),
        field("bounds", &SceneInfo::bounds, "Box around everything."),
        field("memory", &SceneInfo::memory, "What the scene takes."),
        field("warnings", &SceneInfo::warnings,
              "What the importer left out, approximated or repaired."),
    };
  }
  bool operator==(const SceneInfo&) const = default;
};

struct SceneProgress {
  std::string name;
  std::string stage;
  double fraction = 0.0;

  static constexpr auto fields() {
    return std::tuple{
        field("name", &SceneProgress::name, "The scene that is being loaded."),
        field("stage", &SceneProgress::stage, "What is being done."),
        field("fraction", &SceneProgress::fraction, "How much is done.").range(0, 1),
    };
  }
  bool operator==(const SceneProgress&) const = default;
};

struct SceneChanged {
  SceneInfo scene;

  static constexpr auto fields() {
    return std::tuple{field("scene", &SceneChanged::scene, "The scene that is shown now.")};
  }
  bool operator==(const SceneChanged&) const = default;
};

struct SceneUnloaded {
  std::string name;
  std::string by;

  static constexpr auto fields() {
    return std::tuple{
        field("name", &SceneUnloaded::name, "The scene that was shown."),
        field("by", &SceneUnloaded::by, "The viewer that unloaded it; empty: the server."),
    };
  }
  bool operator==(const SceneUnloaded&) const = default;
};

}  // namespace heliograph::protocol
