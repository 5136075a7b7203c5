#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>

#include "scene/environment.hpp"
#include "scene/source_file.hpp"
#include "session/library/scene_catalogue.hpp"

namespace heliograph::session {

/// The .hdr or .exr file that goes with a scene: of its own name, else called sky in its folder or
/// in `root`; nothing when there is none.
std::optional<std::filesystem::path> environment_beside(const std::filesystem::path& scene,
                                                        const std::filesystem::path& root);

/// Finds and reads environments, keeping the last one. Thread safe.
class EnvironmentSource {
 public:
  /// `forced`: the environment of every scene.
  explicit EnvironmentSource(std::optional<std::filesystem::path> forced);

  /// The forced environment, else the one beside the scene, else nothing.
  std::optional<std::filesystem::path> path_for(const CatalogueEntry& entry) const;
  /// The environment in that file; radiance 1 from everywhere where `path` is empty.
  /// @throws scene::ImportError
  std::shared_ptr<const scene::Environment> environment_at(const std::filesystem::path& path);

 private:
  const std::optional<std::filesystem::path> forced_;
  std::mutex mutex_;
  scene::SourceFile last_file_;
  std::shared_ptr<const scene::Environment> last_;
};

}  // namespace heliograph::session
