#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "protocol/result.hpp"
#include "session/library/scene_catalogue.hpp"
#include "session/session.hpp"
#include "session/worker.hpp"

namespace heliograph::render {
class Engine;
}

namespace heliograph::session {

/// The environments that clients may choose: the studio, and every .hdr and .exr file below the
/// scene roots, named like scenes. Loads and prefilters them beside rendering.
class EnvironmentLibrary {
 public:
  EnvironmentLibrary(render::Engine& engine, const SceneCatalogue& catalogue);

  /// All environments as they are on disk now, by name; the studio has no path.
  std::vector<CatalogueEntry> list() const;
  /// Sets the environment of the session's scene. `done` is called once, here or on the loading
  /// thread.
  void show(std::shared_ptr<Session> session, const std::string& name, const std::string& by,
            std::function<void(protocol::Result<void>)> done);
  /// Called when prefiltering throws render::DeviceLost. Set before the first load.
  void on_device_loss(std::function<void()> callback) { on_device_loss_ = std::move(callback); }
  /// Waits for the running load; the others stay unanswered.
  void stop() { loader_.stop(); }

 private:
  protocol::Result<CatalogueEntry> find(const std::string& name) const;
  protocol::Result<void> load_into(Session& session, const CatalogueEntry& entry,
                                   const std::string& by);

  render::Engine& engine_;
  const SceneCatalogue& catalogue_;
  std::function<void()> on_device_loss_;
  Worker loader_;
};

}  // namespace heliograph::session
