#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "protocol/json/fields.hpp"
#include "protocol/limits.hpp"
#include "protocol/messages/kinds.hpp"
#include "protocol/messages/material_messages.hpp"
#include "protocol/messages/scene_messages.hpp"
#include "protocol/messages/section_messages.hpp"
#include "protocol/messages/texture_messages.hpp"

// Messages about what a session has changed in its scene, as one document, and about lights that
// are not in the scene's file.

namespace heliograph::protocol {

/// A light that is not in the scene's file.
struct LightAdd {
  static constexpr bool strict = true;
  LightType type = LightType::point;
  std::optional<std::string> name;
  std::optional<LightPatch> patch;

  static constexpr auto fields() {
    return std::tuple{
        field("type", &LightAdd::type, "Type of the light."),
        field(
            "name", &LightAdd::name,
            "Its name, which no other light may have; absent: one is made. A removed light of the "
            "file comes back by its name.")
            .length(1, max_node_name),
        field("patch", &LightAdd::patch,
              "Its members; absent ones suit the size of the scene, in whose middle it shines from "
              "above."),
    };
  }
  bool operator==(const LightAdd&) const = default;
};

struct LightName {
  std::string light;

  static constexpr auto fields() {
    return std::tuple{
        field("light", &LightName::light, "A name from lights.list.").length(1, max_node_name),
    };
  }
  bool operator==(const LightName&) const = default;
};

/// Of an edit document.
struct EnvironmentEdit {
  static constexpr bool strict = true;
  std::optional<std::string> name;
  float rotation = 0.0f;
  float intensity = 1.0f;

  static constexpr auto fields() {
    return std::tuple{
        field("name", &EnvironmentEdit::name,
              "A name from environment.list; null: the scene's own.")
            .length(1, max_scene_name)
            .or_null(),
        field("rotation", &EnvironmentEdit::rotation, "The setting environment.rotation.")
            .range(-180, 180)
            .unit("degrees")
            .or_default(),
        field("intensity", &EnvironmentEdit::intensity, "The setting environment.intensity.")
            .range(0, 100)
            .or_default(),
    };
  }
  bool operator==(const EnvironmentEdit&) const = default;
};

/// All that differs from a scene's file.
struct EditDocument {
  static constexpr bool strict = true;
  std::uint32_t version = 1;
  std::vector<LightsPatch> lights;
  std::vector<LightAdd> added_lights;
  std::vector<std::string> removed_lights;
  std::vector<MaterialsPatch> materials;
  std::vector<TextureEdit> textures;
  std::vector<std::uint32_t> hidden;
  std::vector<std::uint32_t> isolated;
  std::optional<EnvironmentEdit> environment;
  std::optional<Section> section;

  static constexpr auto fields() {
    return std::tuple{
        field("version", &EditDocument::version, "Version of this format.").range(1, 1),
        field("lights", &EditDocument::lights, "Changes of the file's lights, as lights.patch.")
            .length(0, max_edited_parts)
            .or_default(),
        field("added_lights", &EditDocument::added_lights,
              "Lights that are not in the file, as lights.add.")
            .length(0, max_added_lights)
            .or_default(),
        field("removed_lights", &EditDocument::removed_lights,
              "Names of the file's lights that are removed.")
            .length(0, max_edited_parts)
            .or_default(),
        field("materials", &EditDocument::materials, "Changes of materials, as materials.patch.")
            .length(0, max_edited_parts)
            .or_default(),
        field("textures", &EditDocument::textures,
              "Slots of materials with another image than in the file, or without one.")
            .length(0, max_edited_parts)
            .or_default(),
        field("hidden", &EditDocument::hidden, "Ids of all nodes that are not visible.")
            .length(0, max_edited_nodes)
            .or_default(),
        field("isolated", &EditDocument::isolated, "See nodes.isolate.")
            .length(0, max_edited_nodes)
            .or_default(),
        field("environment", &EditDocument::environment,
              "The environment; absent: it stays as it is."),
        field("section", &EditDocument::section,
              "Planes that cut the scene open and the colour of their caps, as section.set; "
              "absent: no planes."),
    };
  }
  bool operator==(const EditDocument&) const = default;
};

struct EditsApply {
  EditDocument edits;

  static constexpr auto fields() {
    return std::tuple{
        field("edits", &EditsApply::edits, "A document that edits.get returned."),
    };
  }
  bool operator==(const EditsApply&) const = default;
};

struct EditsState {
  std::string scene;
  EditDocument edits;
  std::uint32_t rev = 0;

  static constexpr auto fields() {
    return std::tuple{
        field("scene", &EditsState::scene, "Name of the scene that the document belongs to."),
        field("edits", &EditsState::edits, "All that differs from the scene's file."),
        field("rev", &EditsState::rev, "Revision of the session's state."),
    };
  }
  bool operator==(const EditsState&) const = default;
};

struct EditsChanged {
  std::uint32_t rev = 0;
  std::string by;

  static constexpr auto fields() {
    return std::tuple{
        field("rev", &EditsChanged::rev, "Revision of the session's state."),
        field("by", &EditsChanged::by, "The viewer that changed them; empty: the server."),
    };
  }
  bool operator==(const EditsChanged&) const = default;
};

}  // namespace heliograph::protocol
