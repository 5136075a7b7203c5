#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "protocol/result.hpp"

namespace heliograph::session {

struct CatalogueEntry {
  std::string name;  // path below its root, '/' separated, without .glb or .gltf
  std::uint64_t bytes = 0;
  std::filesystem::path path;  // canonical
  std::filesystem::path root;  // canonical
};

/// The scenes that clients may load: every .glb and .gltf file below the root folders. Clients give
/// names, never paths, and a name is only compared with files that were found, so that neither
/// names nor symbolic links can escape the roots.
class SceneCatalogue {
 public:
  /// @throws std::runtime_error when a root is not a folder
  explicit SceneCatalogue(const std::vector<std::filesystem::path>& roots);

  /// All scenes as they are on disk now, by name. Where two have the same name the earlier root
  /// wins, and .glb wins over .gltf.
  std::vector<CatalogueEntry> list() const;
  /// The same of other files, the earlier extension winning.
  std::vector<CatalogueEntry> list_files(const std::vector<std::string>& extensions) const;
  /// The scene called `name`; its file's extension may be part of it.
  protocol::Result<CatalogueEntry> find(const std::string& name) const;
  /// The scene called `name`, without its file's extension, where it is in a root itself and not in
  /// a folder below. No other file is looked at.
  std::optional<CatalogueEntry> find_in_root(const std::string& name) const;
  /// The same of other files, the earlier extension winning.
  std::optional<CatalogueEntry> find_file_in_root(const std::string& name,
                                                  const std::vector<std::string>& extensions) const;

  const std::vector<std::filesystem::path>& roots() const { return roots_; }

 private:
  std::vector<std::filesystem::path> roots_;
};

}  // namespace heliograph::session
