#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "session/library/scene_catalogue.hpp"

namespace heliograph::session {

/// Small images of the catalogue's scenes, all of one size and from where the scene opens. They are
/// rendered one after another while the server has nothing else to do, and kept in a folder. All
/// functions may be called on any thread.
class SceneThumbnails {
 public:
  using File = std::vector<std::uint8_t>;  // JPEG
  using Rendered = std::function<void(protocol::Result<File>)>;
  /// Renders a scene; the callback is called once, on any thread.
  using Render = std::function<void(const std::string& scene, Rendered)>;

  /// `folder` is made when it is needed; empty: images are kept in memory.
  SceneThumbnails(const SceneCatalogue& catalogue, std::filesystem::path folder, Render render);

  /// The image of a scene, as its file is now. Error not_ready: it is rendered later; not_found:
  /// there is no such scene; invalid: it cannot be loaded.
  protocol::Result<File> get(const std::string& scene);
  /// Where the image of a scene is kept: follows from the scene's file as it is now.
  std::filesystem::path file_of(const CatalogueEntry& entry) const;
  /// Deletes an image after the file of its scene was deleted. `file`: see file_of.
  void forget(const std::filesystem::path& file);
  /// Whether images that were asked for are still to be rendered.
  bool has_work() const;
  /// Begins with the next of these, unless one is being rendered.
  void render_next();

 private:
  bool is_current(const std::string& scene, const std::filesystem::path& file) const;
  void keep(const std::string& scene, const std::filesystem::path& file,
            const protocol::Result<File>& image);
  void rendered(const std::string& scene, const std::filesystem::path& file,
                const protocol::Result<File>& image);

  const SceneCatalogue& catalogue_;
  const std::filesystem::path folder_;
  const Render render_;
  mutable std::mutex mutex_;
  std::deque<std::string> waiting_;
  std::string rendering_;                       // empty: none
  std::map<std::filesystem::path, File> kept_;  // what could not be written
  std::set<std::filesystem::path> failed_;      // files of scenes that cannot be loaded
};

}  // namespace heliograph::session
