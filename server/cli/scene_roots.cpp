#include "cli/scene_roots.hpp"

#include <stdexcept>

namespace heliograph::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* demo_scene = "glossy_sponza_1";

}  // namespace

std::vector<fs::path> choose_scene_roots(const std::vector<fs::path>& given) {
  if (!given.empty()) return given;
  std::error_code error;
  const fs::path executable = fs::read_symlink("/proc/self/exe", error).parent_path();
  // Next to the program in a build folder, then where it is installed.
  for (const fs::path& folder :
       {executable / "../scenes", executable / "../share/heliograph/scenes"}) {
    if (!fs::is_directory(folder, error)) continue;
    if (!session::SceneCatalogue({folder}).list().empty()) return {folder.lexically_normal()};
  }
  return {};
}

std::optional<std::string> choose_scene(const session::SceneCatalogue& catalogue,
                                        const std::string& requested) {
  if (!requested.empty()) {
    const auto found = catalogue.find(requested);
    if (!found) {
      const bool file = fs::is_regular_file(requested);
      throw std::runtime_error("--scene " + requested + ": " + found.error().message +
                               (file ? "; specify its folder with --scene-root" : ""));
    }
    return found->name;
  }
  const std::vector<session::CatalogueEntry> scenes = catalogue.list();
  if (scenes.empty()) return std::nullopt;
  for (const session::CatalogueEntry& scene : scenes) {
    if (scene.name == demo_scene) return scene.name;
  }
  return scenes.front().name;
}

}  // namespace heliograph::cli
