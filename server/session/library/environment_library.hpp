#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "protocol/result.hpp"
#include "scene/source_file.hpp"
#include "session/library/scene_catalogue.hpp"
#include "session/session.hpp"
#include "session/worker.hpp"

namespace heliograph::session {

class RenderDevices;

/// The environments that clients may choose: the studio, and every .hdr and .exr file below the
/// roots of the catalogue, named like scenes. Loads and prefilters them beside rendering.
class EnvironmentLibrary {
 public:
  EnvironmentLibrary(const RenderDevices& devices, SceneCatalogue catalogue);

  /// All environments as they are on disk now, by name; the studio has no path.
  std::vector<CatalogueEntry> list() const;
  protocol::Result<CatalogueEntry> find(const std::string& name) const;
  /// The studio, or one in a root itself; see SceneCatalogue::find_in_root.
  std::optional<CatalogueEntry> find_in_root(const std::string& name) const;
  /// Sets the environment of the session's scene. `done` is called once, here or on the loading
  /// thread.
  void show(std::shared_ptr<Session> session, const std::string& name, const std::string& by,
            std::function<void(protocol::Result<void>)> done);
  using Thumbnail = std::function<void(protocol::Result<std::vector<std::uint8_t>>)>;
  /// A small PNG of an environment, tone mapped; made once for each version of its file. `done` is
  /// called once, here or on a thread of its own.
  void thumbnail(const std::string& name, Thumbnail done);
  /// Frees the image of an environment whose file is gone.
  void forget_thumbnail(const std::string& name);
  /// Called with the index of the device when prefiltering throws render::DeviceLost. Set before
  /// the first load.
  void on_device_loss(std::function<void(std::size_t)> callback) {
    on_device_loss_ = std::move(callback);
  }
  /// Waits for the running load; the others stay unanswered.
  void stop();

 private:
  protocol::Result<std::vector<std::uint8_t>> make_thumbnail(const CatalogueEntry& entry);
  protocol::Result<void> load_into(Session& session, const CatalogueEntry& entry,
                                   const std::string& by);

  const RenderDevices& devices_;
  const SceneCatalogue catalogue_;
  std::function<void(std::size_t)> on_device_loss_;
  struct CachedThumbnail {
    scene::SourceFile file;
    std::vector<std::uint8_t> png;
  };
  std::map<std::string, CachedThumbnail> thumbnails_;  // by name; of the thumbnails' thread
  Worker loader_;
  Worker thumbnail_maker_;
};

}  // namespace heliograph::session
