#include "session/environment_choice.hpp"

#include <utility>

namespace heliograph::session {

namespace fs = std::filesystem;

std::optional<fs::path> environment_beside(const fs::path& scene, const fs::path& root) {
  for (const fs::path& place :
       {fs::path(scene).replace_extension(), scene.parent_path() / "sky", root / "sky"}) {
    for (const char* extension : {".hdr", ".exr"}) {
      const fs::path candidate = fs::path(place).concat(extension);
      std::error_code error;
      if (fs::is_regular_file(candidate, error)) return candidate;
    }
  }
  return std::nullopt;
}

EnvironmentSource::EnvironmentSource(std::optional<fs::path> forced) : forced_(std::move(forced)) {}

std::shared_ptr<const scene::Environment> EnvironmentSource::environment_for(
    const CatalogueEntry& entry) {
  const std::optional<fs::path> path =
      forced_ ? forced_ : environment_beside(entry.path, entry.root);
  const std::lock_guard lock(mutex_);
  if (last_ && last_path_ == path.value_or(fs::path())) return last_;
  auto environment = std::make_shared<const scene::Environment>(
      path ? scene::load_environment(*path) : scene::constant_environment(glm::vec3(1.0f)));
  last_ = std::move(environment);
  last_path_ = path.value_or(fs::path());
  return last_;
}

}  // namespace heliograph::session
