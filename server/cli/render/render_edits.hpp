#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "protocol/messages/edit_messages.hpp"
#include "protocol/messages/render_messages.hpp"
#include "render/api/renderer.hpp"
#include "scene/scene.hpp"
#include "scene/texture_override.hpp"
#include "session/edits/animated_parts.hpp"
#include "session/edits/scene_edits.hpp"
#include "session/edits/section_planes.hpp"

namespace heliograph::cli {

/// The document of --edits.
/// @throws std::runtime_error, std::invalid_argument naming the option
protocol::EditDocument read_edits(const std::string& file);
/// The camera path of --path, likewise.
protocol::CameraPath read_path(const std::string& file);

/// The file of the environment that a document names, among those beside the scene and below its
/// folder; empty: the studio.
/// @throws std::runtime_error
std::filesystem::path edited_environment(const std::string& name,
                                         const std::filesystem::path& scene);

/// The folders where the images are that a document puts in the place of textures: that of
/// --images, or else those of --edits and of the scene.
std::vector<std::filesystem::path> image_folders(const std::string& images,
                                                 const std::string& edits,
                                                 const std::filesystem::path& scene);

/// The images of a document in the place of textures, among those in the folders and below them.
/// @throws std::runtime_error
std::vector<scene::TextureOverride> edited_textures(
    const protocol::EditDocument& document, const std::vector<std::filesystem::path>& folders);

/// What a document changes in a scene.
class RenderEdits {
 public:
  RenderEdits() = default;
  /// @throws std::runtime_error where the document does not fit the scene
  RenderEdits(std::shared_ptr<const scene::Scene> scene, const protocol::EditDocument& document);

  /// What no clip changes; after set_scene.
  void apply(render::Renderer& renderer) const;
  /// Lights, materials and hidden instances at `seconds` of a clip, whose name may be empty, to a
  /// renderer that has `shown`.
  void show(render::Renderer& renderer, session::ShownParts& shown, const std::string& clip,
            double seconds) const;

 private:
  std::shared_ptr<const scene::Scene> scene_;
  session::SceneParts parts_;
  session::EditedMembers members_;
  session::SectionPlanes section_;
};

}  // namespace heliograph::cli
