#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>

#include "scene/environment.hpp"
#include "scene/scene.hpp"
#include "scene/source_file.hpp"
#include "session/library/scene_catalogue.hpp"

namespace heliograph::session {

/// The .hdr or .exr file of a scene: of its own name, else called sky in its folder or in `root`.
std::optional<std::filesystem::path> environment_beside(const std::filesystem::path& scene,
                                                        const std::filesystem::path& root);

/// Finds and loads environments, and caches the last one. Thread safe.
class EnvironmentSource {
 public:
  /// `forced`: the environment of every scene.
  explicit EnvironmentSource(std::optional<std::filesystem::path> forced);

  /// The forced environment, else the one beside the scene.
  std::optional<std::filesystem::path> path_for(const CatalogueEntry& entry) const;
  /// Whether the file of a scene has the light around it, and none is forced.
  bool is_lit_by_its_file(const scene::Scene& scene) const { return scene.environment && !forced_; }
  /// That light, else the environment in the file of path_for(); for an empty path the studio.
  /// @throws scene::ImportError
  std::shared_ptr<const scene::Environment> environment_of(const scene::Scene& scene,
                                                           const std::filesystem::path& path) {
    return is_lit_by_its_file(scene) ? scene.environment : environment_at(path);
  }
  /// The environment in that file; for an empty path the studio.
  /// @throws scene::ImportError
  std::shared_ptr<const scene::Environment> environment_at(const std::filesystem::path& path);

 private:
  const std::optional<std::filesystem::path> forced_;
  std::mutex mutex_;
  scene::SourceFile last_file_;
  std::shared_ptr<const scene::Environment> last_;
};

}  // namespace heliograph::session
