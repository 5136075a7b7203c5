#include "session/library/environment_source.hpp"

#include <utility>

#include "scene/studio.hpp"

namespace heliograph::session {

namespace fs = std::filesystem;

std::optional<fs::path> environment_beside(const fs::path& scene, const fs::path& root) {
  for (const fs::path& stem :
       {fs::path(scene).replace_extension(), scene.parent_path() / "sky", root / "sky"}) {
    for (const char* extension : {".hdr", ".exr"}) {
      const fs::path candidate = fs::path(stem).concat(extension);
      std::error_code error;
      if (fs::is_regular_file(candidate, error)) return candidate;
    }
  }
  return std::nullopt;
}

EnvironmentSource::EnvironmentSource(std::optional<fs::path> forced) : forced_(std::move(forced)) {}

std::optional<fs::path> EnvironmentSource::path_for(const CatalogueEntry& entry) const {
  return forced_ ? forced_ : environment_beside(entry.path, entry.root);
}

std::shared_ptr<const scene::Environment> EnvironmentSource::environment_at(const fs::path& path) {
  const std::lock_guard lock(mutex_);
  const scene::SourceFile file = scene::examine_file(path);
  if (last_ && last_file_ == file) return last_;
  last_ = std::make_shared<const scene::Environment>(path.empty() ? scene::studio_environment()
                                                                  : scene::load_environment(path));
  last_file_ = file;
  return last_;
}

}  // namespace heliograph::session
