#pragma once

#include <memory>
#include <optional>
#include <string>

#include "session/edits/scene_export.hpp"
#include "session/library/loaded_scene.hpp"
#include "session/state/session_core.hpp"

namespace heliograph::session {

/// Commands on the scene of a session, its lights, materials and environment. Thread safe. `by` is
/// the viewer that asks, empty for a caller without a stream.
class SessionScene {
 public:
  explicit SessionScene(SessionCore& core) : core_(core) {}

  protocol::Result<protocol::SceneInfo> info() const;
  /// As its file has it.
  void show(LoadedScene scene, const std::string& by);
  /// With the changes of the document.
  /// @return an error where the document does not fit; the scene of before stays
  protocol::Result<void> show(LoadedScene scene, const protocol::EditDocument& edits,
                              const std::string& by);
  /// The same scene with other textures: camera, time, selection and what was edited stay, or the
  /// changes of `edits` take its place.
  /// @return an error where the document does not fit, or no scene is shown any more
  protocol::Result<void> show_variant(LoadedScene scene,
                                      const std::optional<protocol::EditDocument>& edits,
                                      const std::string& by);
  void unload(const std::string& by);
  /// Shows a scene without its textures to the viewers until show() gives the whole one, which
  /// takes the camera over, or end_first_view() brings the session's own back.
  void show_first_view(std::shared_ptr<const scene::Scene> scene,
                       std::shared_ptr<const render::SceneResources> resources,
                       const std::string& by);
  void end_first_view();

  protocol::Result<protocol::LightList> lights() const;
  protocol::Result<protocol::LightState> patch_light(const protocol::LightsPatch& request,
                                                     const std::string& by);
  protocol::Result<protocol::LightState> add_light(const protocol::LightAdd& request,
                                                   const std::string& by);
  protocol::Result<protocol::LightList> remove_light(const protocol::LightName& request,
                                                     const std::string& by);
  protocol::Result<protocol::MaterialList> materials() const;
  protocol::Result<protocol::MaterialState> patch_material(const protocol::MaterialsPatch& request,
                                                           const std::string& by);
  protocol::Result<protocol::TextureList> textures() const;
  protocol::Result<protocol::TextureState> texture(const std::string& material,
                                                   const std::string& slot) const;
  /// What loads the scene that is shown, as it was asked for.
  struct Shown {
    std::string name;
    std::shared_ptr<const scene::Scene> scene;
  };
  protocol::Result<Shown> shown() const;
  protocol::Result<protocol::SectionState> section() const;
  protocol::Result<protocol::SectionState> set_section(const protocol::Section& section,
                                                       const std::string& by);
  protocol::Result<protocol::EditsState> edits() const;
  /// The scene as it is edited, for a file.
  protocol::Result<SceneExport> exported() const;
  /// All but the choice of an environment by name.
  protocol::Result<void> apply_edits(const protocol::EditDocument& document, const std::string& by);
  /// What is in effect, without the environments of the catalogue.
  protocol::EnvironmentState environment() const;
  /// `environment` is the one called `name`; both empty: the scene's own.
  protocol::Result<void> set_environment(std::optional<std::string> name,
                                         std::shared_ptr<const render::LitEnvironment> environment,
                                         const std::string& by);

 private:
  protocol::SectionState section_state() const;
  protocol::EditDocument described_edits() const;
  /// Takes the document's place for all that was changed before; `scene` is to be shown.
  protocol::Result<void> adopt(const std::shared_ptr<const scene::Scene>& scene,
                               const protocol::EditDocument& document, const std::string& by);
  void edits_changed(const std::string& by);

  SessionCore& core_;
};

}  // namespace heliograph::session
