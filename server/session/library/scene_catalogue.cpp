#include "session/library/scene_catalogue.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string_view>

#include "protocol/json/suggestions.hpp"

namespace heliograph::session {
namespace {

namespace fs = std::filesystem;

// A root that is a whole disk must not block the server.
constexpr int max_depth = 12;
constexpr std::size_t max_files_visited = 100'000;

std::vector<std::string> scene_extensions() {
  return {".glb", ".gltf"};
}

bool is_inside(const fs::path& path, const fs::path& root) {
  return std::mismatch(root.begin(), root.end(), path.begin(), path.end()).first == root.end();
}

std::optional<CatalogueEntry> entry_of(const fs::path& file, const fs::path& root) {
  std::error_code error;
  const fs::path resolved = fs::canonical(file, error);
  if (error || !is_inside(resolved, root) || !fs::is_regular_file(resolved, error)) {
    return std::nullopt;
  }
  const std::uintmax_t bytes = fs::file_size(resolved, error);
  if (error) return std::nullopt;
  fs::path name = file.lexically_relative(root);
  return CatalogueEntry{.name = name.replace_extension().generic_string(),
                        .bytes = bytes,
                        .path = resolved,
                        .root = root};
}

std::vector<CatalogueEntry> files_below(const fs::path& root,
                                        const std::vector<std::string>& extensions) {
  const auto rank = [&](const fs::path& path) {
    return std::find(extensions.begin(), extensions.end(), path.extension()) - extensions.begin();
  };
  std::vector<CatalogueEntry> found;
  std::error_code error;
  std::size_t visited = 0;
  fs::recursive_directory_iterator folder(root, fs::directory_options::skip_permission_denied,
                                          error);
  for (; !error && folder != fs::recursive_directory_iterator(); folder.increment(error)) {
    if (++visited > max_files_visited) break;
    if (folder.depth() >= max_depth) folder.disable_recursion_pending();
    if (rank(folder->path()) == std::ssize(extensions)) continue;
    if (auto entry = entry_of(folder->path(), root)) found.push_back(*std::move(entry));
  }
  std::stable_sort(found.begin(), found.end(),
                   [&](const CatalogueEntry& a, const CatalogueEntry& b) {
                     return rank(a.path) < rank(b.path);
                   });
  return found;
}

}  // namespace

SceneCatalogue::SceneCatalogue(const std::vector<fs::path>& roots) {
  for (const fs::path& root : roots) {
    std::error_code error;
    const fs::path resolved = fs::canonical(root, error);
    if (error || !fs::is_directory(resolved, error)) {
      throw std::runtime_error("the scene root " + root.string() + " is not a folder");
    }
    roots_.push_back(resolved);
  }
}

std::vector<CatalogueEntry> SceneCatalogue::list() const {
  return list_files(scene_extensions());
}

std::vector<CatalogueEntry> SceneCatalogue::list_files(
    const std::vector<std::string>& extensions) const {
  std::map<std::string, CatalogueEntry> by_name;
  for (const fs::path& root : roots_) {
    for (CatalogueEntry& entry : files_below(root, extensions)) by_name.emplace(entry.name, entry);
  }
  std::vector<CatalogueEntry> scenes;
  for (auto& [name, entry] : by_name) scenes.push_back(std::move(entry));
  return scenes;
}

protocol::Result<CatalogueEntry> SceneCatalogue::find(const std::string& name) const {
  const std::vector<CatalogueEntry> scenes = list();
  for (const CatalogueEntry& entry : scenes) {
    if (entry.name == name || entry.name + entry.path.extension().string() == name) return entry;
  }
  std::vector<std::string_view> names;
  for (const CatalogueEntry& entry : scenes) names.push_back(entry.name);
  return protocol::error::not_found("name",
                                    "is not in the catalogue" + protocol::suggestion(name, names));
}

std::optional<CatalogueEntry> SceneCatalogue::find_in_root(const std::string& name) const {
  return find_file_in_root(name, scene_extensions());
}

std::optional<CatalogueEntry> SceneCatalogue::find_file_in_root(
    const std::string& name, const std::vector<std::string>& extensions) const {
  if (name.find('/') != std::string::npos) return std::nullopt;
  for (const fs::path& root : roots_) {
    for (const std::string& extension : extensions) {
      if (auto entry = entry_of(root / (name + extension), root)) return entry;
    }
  }
  return std::nullopt;
}

}  // namespace heliograph::session
