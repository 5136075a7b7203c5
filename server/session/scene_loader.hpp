#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "protocol/messages.hpp"
#include "scene/import.hpp"
#include "session/environment_choice.hpp"
#include "session/scene_catalogue.hpp"
#include "session/session.hpp"

namespace heliograph::render {
class Engine;
}

namespace heliograph::session {

/// Loads scenes beside rendering and puts them into sessions when they are complete. On failure a
/// session keeps what it has. A newer request takes the place of an older one, also of one that is
/// under way.
class SceneLoader {
 public:
  using Completion = std::function<void(protocol::Result<protocol::SceneInfo>)>;

  SceneLoader(render::Engine& engine, const SceneCatalogue& catalogue,
              std::optional<std::filesystem::path> environment, const scene::ImportLimits& limits);
  ~SceneLoader() { stop(); }
  SceneLoader(const SceneLoader&) = delete;
  SceneLoader& operator=(const SceneLoader&) = delete;

  /// `done` is called once, here or on the loading thread.
  void load(std::shared_ptr<Session> session, const std::string& name, const std::string& by,
            Completion done);

  /// Ends the thread and the load under way; what waits is dropped unanswered.
  void stop();

 private:
  struct Request {
    std::shared_ptr<Session> session;
    CatalogueEntry entry;
    std::string by;
    Completion done;
    std::uint64_t number = 0;
  };

  void run();
  protocol::Result<protocol::SceneInfo> carry_out(const Request& request);
  void report_progress(const Request& request, std::string_view stage, float fraction) const;
  void stop_if_superseded(const Request& request) const;

  render::Engine& engine_;
  const SceneCatalogue& catalogue_;
  EnvironmentSource environments_;
  const scene::ImportLimits limits_;

  std::mutex mutex_;
  std::condition_variable condition_;
  std::optional<Request> waiting_;
  std::atomic<std::uint64_t> newest_number_ = 0;
  std::atomic<bool> stopping_ = false;
  std::thread thread_;
};

}  // namespace heliograph::session
