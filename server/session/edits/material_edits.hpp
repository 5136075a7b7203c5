#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "protocol/messages/edit_messages.hpp"
#include "protocol/result.hpp"
#include "scene/scene.hpp"

namespace heliograph::session {

/// The materials of a scene with the changes of one session. A refused request changes nothing. Not
/// thread safe.
class MaterialEdits {
 public:
  using Materials = std::vector<shared::Material>;
  using Layers = std::vector<shared::MaterialLayer>;

  MaterialEdits() = default;
  explicit MaterialEdits(std::shared_ptr<const scene::Scene> scene);

  const std::vector<protocol::MaterialInfo>& list() const { return materials_; }
  protocol::Result<protocol::MaterialInfo> patch(const protocol::MaterialsPatch& request);

  /// The part of a document that is about materials.
  void describe_edits(protocol::EditDocument& document) const;
  /// Of materials that are as in the file; errors name the entry of the document.
  protocol::Result<void> apply(const protocol::EditDocument& document);

  /// In the order of the scene; null until a value differs from the file. A patch makes a new list:
  /// references to the old one stay valid and unchanged.
  const std::shared_ptr<const Materials>& device() const { return device_; }
  /// What Material::layer of device() counts: the layers of the scene, then those of materials
  /// whose extensions were edited. Null: the scene's. A new list comes with a new device() only.
  const std::shared_ptr<const Layers>& device_layers() const { return device_layers_; }
  /// list() as of device(), for what animates the others of their members; null as long as that is,
  /// and where no clip animates materials.
  const std::shared_ptr<const std::vector<protocol::MaterialInfo>>& shared_list() const {
    return shared_list_;
  }

 private:
  std::uint32_t own_layer(std::size_t material, const shared::MaterialLayer& layer);

  std::shared_ptr<const scene::Scene> scene_;
  std::vector<protocol::MaterialInfo> materials_;
  std::shared_ptr<const Materials> device_;
  std::map<std::size_t, std::uint32_t> own_layers_;  // by material
  std::shared_ptr<const Layers> device_layers_;
  std::shared_ptr<const std::vector<protocol::MaterialInfo>> shared_list_;
};

/// The materials of the file. Names are unique: a material without one gets its number.
std::vector<protocol::MaterialInfo> describe_materials(const scene::Scene& scene);

}  // namespace heliograph::session
