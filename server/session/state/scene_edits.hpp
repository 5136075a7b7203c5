#pragma once

#include <memory>
#include <string>
#include <vector>

#include "protocol/messages/scene_messages.hpp"
#include "protocol/result.hpp"
#include "scene/scene.hpp"

namespace heliograph::session {

/// The lights and materials of a scene as one session has them: those of the file until they are
/// patched. Only these small tables are copied; geometry and textures stay shared.
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

  /// In the order of the scene; null as long as nothing differs from the file. A patch makes a new
  /// list: whoever holds an old one keeps it as it was.
  const std::shared_ptr<const Lights>& device_lights() const { return device_lights_; }
  const std::shared_ptr<const Materials>& device_materials() const { return device_materials_; }

 private:
  std::shared_ptr<const scene::Scene> scene_;
  std::vector<protocol::LightInfo> lights_;
  std::vector<protocol::MaterialInfo> materials_;
  std::shared_ptr<const Lights> device_lights_;
  std::shared_ptr<const Materials> device_materials_;
};

/// What the file says of its materials. Names are unique: a material without one gets its index.
std::vector<protocol::MaterialInfo> describe_materials(const scene::Scene& scene);

}  // namespace heliograph::session
