#pragma once

#include <memory>
#include <string>
#include <vector>

#include "protocol/messages/edit_messages.hpp"
#include "protocol/result.hpp"
#include "scene/gltf/export/scene_changes.hpp"
#include "scene/scene.hpp"

namespace heliograph::session {

/// The lights of a scene with the changes of one session: some differ from the file, some are
/// removed, some are added. A refused request changes nothing. Not thread safe.
class LightEdits {
 public:
  using Lights = std::vector<shared::Light>;

  LightEdits() = default;
  explicit LightEdits(std::shared_ptr<const scene::Scene> scene);

  /// Those that there are: the file's first, in its order.
  std::vector<protocol::LightInfo> list() const;
  protocol::Result<protocol::LightInfo> patch(const protocol::LightsPatch& request);
  protocol::Result<protocol::LightInfo> add(const protocol::LightAdd& request);
  protocol::Result<void> remove(const std::string& name);

  /// The parts of a document that are about lights.
  void describe_edits(protocol::EditDocument& document) const;
  /// Of lights that are as in the file; errors name the entry of the document.
  protocol::Result<void> apply(const protocol::EditDocument& document);

  /// In the order of the scene, those that are removed without light, then those that are added;
  /// null until anything differs from the file. A change makes a new list: references to the old
  /// one stay valid and unchanged.
  const std::shared_ptr<const Lights>& device() const { return device_; }
  /// The same for a file: those that are off keep their colour.
  std::vector<scene::LightChange> changes() const;
  /// The lights of the file as of device(), removed ones as lights that are off, for what animates
  /// the others of their members; null as long as that is, and where no clip animates them.
  const std::shared_ptr<const std::vector<protocol::LightInfo>>& shared_list() const {
    return shared_list_;
  }

 private:
  struct Light {
    protocol::LightInfo initial;  // of the file, or as it was added
    protocol::LightInfo now;
    shared::Light device;  // of `initial`
    bool removed = false;
  };

  Light* find(const std::string& name);
  protocol::Error unknown(const std::string& name) const;
  protocol::Result<protocol::LightInfo> bring_back(Light& light, const protocol::LightAdd& request);
  Light make_light(protocol::LightType type) const;
  void update_device();
  void share_list();

  std::shared_ptr<const scene::Scene> scene_;
  std::vector<Light> lights_;
  std::shared_ptr<const Lights> device_;
  std::shared_ptr<const std::vector<protocol::LightInfo>> shared_list_;
};

}  // namespace heliograph::session
