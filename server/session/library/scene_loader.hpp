#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "protocol/messages/messages.hpp"
#include "scene/import.hpp"
#include "session/library/scene_cache.hpp"
#include "session/library/scene_catalogue.hpp"
#include "session/state/environment_choice.hpp"
#include "session/state/session.hpp"

namespace heliograph::render {
class Engine;
}

namespace heliograph::session {

struct LoaderOptions {
  std::optional<std::filesystem::path> environment;  // of every scene, instead of its own
  scene::ImportLimits limits;
  std::uint64_t cache_bytes = 1ull << 30;  // see SceneCache
};

/// Loads scenes beside rendering, one after the other, and puts them into sessions when they are
/// complete. On failure a session keeps what it has. A newer request of a session takes the place
/// of its older one, also of one that is under way, and what a session waited for ends with it.
/// Requests for the same thing share one load, and what was loaded stays in a cache. Thread safe.
class SceneLoader {
 public:
  using Completion = std::function<void(protocol::Result<protocol::SceneInfo>)>;

  SceneLoader(render::Engine& engine, const SceneCatalogue& catalogue, LoaderOptions options);
  ~SceneLoader() { stop(); }
  SceneLoader(const SceneLoader&) = delete;
  SceneLoader& operator=(const SceneLoader&) = delete;

  /// `done` is called once, here or on the loading thread, without locks.
  void load(std::shared_ptr<Session> session, const protocol::SceneLoad& request,
            const std::string& by, Completion done);
  /// Ends what `session` waits for: whoever asked for it is told so, and the load itself ends soon
  /// unless others wait for it too.
  protocol::SceneCancelled cancel(const Session& session);

  /// Ends the thread and the load under way; all that wait are told.
  void stop();

  /// Called on the loading thread when a load meets render::DeviceLost; `take_new_device` must
  /// follow. Set before the first load.
  void on_device_loss(std::function<void()> callback) { on_device_loss_ = std::move(callback); }
  /// There is another device: what is kept of the last one is of no use, and a load that met its
  /// end begins anew.
  void take_new_device();

  CacheTotals cache_totals() const { return cache_.totals(); }

 private:
  struct Waiter {
    std::shared_ptr<Session> session;
    std::string by;
    Completion done;
  };
  struct Job {
    SceneKey key;
    CatalogueEntry entry;
    std::vector<Waiter> waiters;  // guarded by mutex_
    std::atomic<bool> abandoned = false;
    std::string stage;  // of the newest report; this and the rest are the loading thread's
    float fraction = 0.0f;
    int losses = 0;  // of the device meanwhile
  };

  void run();
  std::shared_ptr<Job> next_job();
  void carry_out(Job& job);
  std::string sessions_of(const Job& job);
  LoadedScene make(Job& job);
  void report_device_loss(Job& job);
  void finish(Job& job, const protocol::Result<LoadedScene>& outcome);
  std::vector<Waiter> remove_waiters(const std::function<bool(const Session&)>& whose,
                                     const Job* except = nullptr);
  void dismiss_ended();
  std::shared_ptr<Job> find_job(const SceneKey& key) const;
  void report_progress(Job& job, std::string_view stage, float fraction);
  void stop_if_abandoned(const Job& job);

  render::Engine& engine_;
  const SceneCatalogue& catalogue_;
  EnvironmentSource environments_;
  const LoaderOptions options_;
  SceneCache cache_;
  std::function<void()> on_device_loss_;

  std::mutex mutex_;
  std::condition_variable condition_;
  std::deque<std::shared_ptr<Job>> jobs_;  // the first may be under way
  bool device_ready_ = true;               // guarded by mutex_
  bool memory_is_loose_ = false;           // the loading thread's
  std::atomic<bool> stopping_ = false;
  std::thread thread_;
};

}  // namespace heliograph::session
