#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>

#include "scene/environment.hpp"
#include "session/scene_catalogue.hpp"

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

  /// The forced environment, else the one beside the scene, else radiance 1 from everywhere.
  /// @throws scene::ImportError
  std::shared_ptr<const scene::Environment> environment_for(const CatalogueEntry& entry);

 private:
  const std::optional<std::filesystem::path> forced_;
  std::mutex mutex_;
  std::filesystem::path last_path_;
  std::shared_ptr<const scene::Environment> last_;
};

}  // namespace heliograph::session
