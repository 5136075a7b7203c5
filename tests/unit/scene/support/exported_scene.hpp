#pragma once

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "scene/gltf/export/glb_export.hpp"
#include "scene/import.hpp"
#include "tests/unit/scene/support/gltf_builder.hpp"

namespace heliograph::scene::test {

/// A scene in a folder, its export, and the export imported again.
class Exported {
 public:
  explicit Exported(const GltfBuilder& builder, const SceneChoice& choice = {})
      : Exported(builder.glb(), "scene.glb", choice) {}
  Exported(const Bytes& file, const std::string& name, const SceneChoice& choice = {},
           const std::vector<std::pair<std::string, Bytes>>& beside = {}) {
    for (const auto& [other, bytes] : beside) folder.write(other, bytes);
    before = import_gltf(folder.write(name, file), {}, {.choice = choice});
  }

  /// Exports with `changes` and imports in a folder without other files.
  void write() {
    std::ostringstream out;
    warnings = export_glb(before, changes, limits, out);
    file = std::move(out).str();
    const TemporaryFolder alone;
    after = import_gltf(alone.write("exported.glb", file), strict_limits);
  }
  void edit_lights() {
    for (const Light& light : before.lights) {
      changes.lights.push_back({.name = light.name, .device = light.device});
    }
  }
  shared::Light& light(std::size_t index) { return changes.lights.at(index).device; }
  shared::Material& material(std::size_t index) {
    if (changes.materials.empty()) changes.materials = before.materials;
    return changes.materials.at(index);
  }
  /// Of the exported file.
  nlohmann::json document() const {
    std::uint32_t length = 0;
    std::memcpy(&length, file.data() + 12, sizeof length);
    return nlohmann::json::parse(file.substr(20, length));
  }

  TemporaryFolder folder;
  ImportLimits limits;
  SceneChanges changes;
  Scene before;
  Scene after;
  std::string file;
  std::vector<std::string> warnings;
};

}  // namespace heliograph::scene::test
