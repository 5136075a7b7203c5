#pragma once

#include <memory>
#include <vector>

#include "session/edits/light_edits.hpp"
#include "session/edits/material_edits.hpp"

namespace heliograph::session {

/// Lights, materials and hidden instances of a scene, as a renderer takes them.
struct SceneParts {
  std::shared_ptr<const LightEdits::Lights> lights = nullptr;           // null: the scene's own
  std::shared_ptr<const MaterialEdits::Materials> materials = nullptr;  // null: the scene's own
  std::shared_ptr<const MaterialEdits::Layers> layers =
      nullptr;                                                // of `materials`; null: the scene's
  std::shared_ptr<const std::vector<bool>> hidden = nullptr;  // by instance; null: none
  bool operator==(const SceneParts&) const = default;
};

/// Which members of lights and materials were edited, where clips animate others; null: none.
struct EditedMembers {
  std::shared_ptr<const std::vector<protocol::LightInfo>> lights = nullptr;
  std::shared_ptr<const std::vector<protocol::MaterialInfo>> materials = nullptr;
};

/// The lights and materials of a scene with the changes of one session. Only these small tables are
/// copied; geometry and textures stay shared.
class SceneEdits {
 public:
  using Lights = LightEdits::Lights;
  using Materials = MaterialEdits::Materials;
  using Layers = MaterialEdits::Layers;

  SceneEdits() = default;
  explicit SceneEdits(const std::shared_ptr<const scene::Scene>& scene)
      : lights_(scene), materials_(scene) {}

  std::vector<protocol::LightInfo> lights() const { return lights_.list(); }
  const std::vector<protocol::MaterialInfo>& materials() const { return materials_.list(); }

  protocol::Result<protocol::LightInfo> patch(const protocol::LightsPatch& request) {
    return lights_.patch(request);
  }
  protocol::Result<protocol::LightInfo> add(const protocol::LightAdd& request) {
    return lights_.add(request);
  }
  protocol::Result<void> remove_light(const std::string& name) { return lights_.remove(name); }
  protocol::Result<protocol::MaterialInfo> patch(const protocol::MaterialsPatch& request) {
    return materials_.patch(request);
  }

  /// The parts of a document that are about lights and materials.
  void describe(protocol::EditDocument& document) const {
    lights_.describe_edits(document);
    materials_.describe_edits(document);
  }
  /// Of a scene that is as its file; errors name the entry of the document.
  protocol::Result<void> apply(const protocol::EditDocument& document) {
    if (const auto applied = lights_.apply(document); !applied) return applied;
    return materials_.apply(document);
  }

  /// See LightEdits::changes.
  std::vector<scene::LightChange> light_changes() const { return lights_.changes(); }
  /// See LightEdits::device, MaterialEdits::device and MaterialEdits::device_layers.
  const std::shared_ptr<const Lights>& device_lights() const { return lights_.device(); }
  const std::shared_ptr<const Materials>& device_materials() const { return materials_.device(); }
  const std::shared_ptr<const Layers>& device_layers() const { return materials_.device_layers(); }
  /// See LightEdits::shared_list and MaterialEdits::shared_list.
  EditedMembers edited_members() const { return {lights_.shared_list(), materials_.shared_list()}; }

 private:
  LightEdits lights_;
  MaterialEdits materials_;
};

}  // namespace heliograph::session
