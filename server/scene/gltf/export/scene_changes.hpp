#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace heliograph::scene {

/// A light as it is now.
struct LightChange {
  std::string name;      // of an added one
  shared::Light device;  // with its colour also where it is off
  bool off = false;
  bool removed = false;
};

/// What differs from a scene's file.
struct SceneChanges {
  std::vector<shared::Material> materials;  // all of the scene, in its order; empty: as in the file
  /// By material, where its extensions differ from the file; or empty.
  std::vector<std::optional<MaterialLayers>> extensions;
  std::vector<LightChange> lights;    // those of the scene, then those that are added; or empty
  std::vector<std::uint32_t> hidden;  // nodes of the scene, which hide those below them
};

}  // namespace heliograph::scene
