#pragma once

#include <memory>
#include <string>
#include <vector>

#include "protocol/messages/scene_messages.hpp"
#include "protocol/result.hpp"
#include "scene/scene.hpp"

namespace heliograph::session {

/// The lights and materials of a scene with the changes of one session. Only these small tables are
/// copied; geometry and textures stay shared.
class SceneEdits {
 public:
  using Lights = std::vector<shared::Light>;
  using Materials = std::vector<shared::Material>;

  SceneEdits() = default;
  explicit SceneEdits(std::shared_ptr<const scene::Scene> scene);

  const std::vector<protocol::LightInfo>& lights() const { return lights_; }
  const std::vector<protocol::MaterialInfo>& materials() const { return materials_; }

  protocol::Result<protocol::LightInfo> patch(const protocol::LightsPatch& request);
  protocol::Result<protocol::MaterialInfo> patch(const protocol::MaterialsPatch& request);

  /// In the order of the scene; null until a value differs from the file. A patch makes a new list:
  /// references to the old one stay valid and unchanged.
  const std::shared_ptr<const Lights>& device_lights() const { return device_lights_; }
  const std::shared_ptr<const Materials>& device_materials() const { return device_materials_; }

 private:
  std::shared_ptr<const scene::Scene> scene_;
  std::vector<protocol::LightInfo> lights_;
  std::vector<protocol::MaterialInfo> materials_;
  std::shared_ptr<const Lights> device_lights_;
  std::shared_ptr<const Materials> device_materials_;
};

/// The materials of the file. Names are unique: a material without one gets its number.
std::vector<protocol::MaterialInfo> describe_materials(const scene::Scene& scene);

}  // namespace heliograph::session
