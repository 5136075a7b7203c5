#pragma once

#include <atomic>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "protocol/messages/messages.hpp"
#include "scene/import.hpp"
#include "session/library/environment_source.hpp"
#include "session/library/scene_cache.hpp"
#include "session/library/scene_catalogue.hpp"
#include "session/session.hpp"

namespace heliograph::session {

class RenderDevices;

struct LoaderOptions {
  std::optional<std::filesystem::path> environment;  // of every scene, instead of its own
  scene::ImportLimits limits;
  std::uint64_t cache_bytes = 1ull << 30;  // see SceneCache
  /// Viewers see scenes whose images have larger files before these are decoded.
  std::uint64_t first_view_bytes = 8ull << 20;
};

/// Loads scenes beside rendering, one after the other, and shows them in sessions when they are
/// complete; viewers see those with large images before, without their textures. On failure a
/// session keeps its scene. A newer request of a session replaces its older one, even if that is
/// being loaded; requests of a session that ends fail. Requests for the same scene on the same
/// device share one load, and loaded scenes stay in a cache. A scene goes to the device of the
/// session that shows it; another device takes it over without another import. Thread safe.
class SceneLoader {
 public:
  using Completion = std::function<void(protocol::Result<protocol::SceneInfo>)>;

  SceneLoader(RenderDevices& devices, const SceneCatalogue& catalogue, LoaderOptions options);
  ~SceneLoader() { stop(); }
  SceneLoader(const SceneLoader&) = delete;
  SceneLoader& operator=(const SceneLoader&) = delete;

  using Textures = std::vector<scene::TextureOverride>;

  /// `textures`, sorted, take the place of those of the file; the request's edits do not count for
  /// them. `done` is called once, here or on the loading thread, without locks.
  void load(std::shared_ptr<Session> session, const protocol::SceneLoad& request, Textures textures,
            const std::string& by, Completion done);
  /// Shows the scene of the session with other textures, and with `edits` in place of its edits
  /// if they are given. Answers also the requests of this kind that it replaces. Fails while the
  /// session waits for another scene.
  void load_textures(std::shared_ptr<Session> session, Textures textures,
                     std::optional<protocol::EditDocument> edits, const std::string& by,
                     Completion done);
  /// Those that the session is to show by a request of load_textures; nothing: there is none.
  std::optional<Textures> pending_textures(const Session& session);
  /// Cancels the request of `session`, which fails; the load itself stops soon unless other
  /// sessions wait for it.
  protocol::SceneCancelled cancel(const Session& session);

  /// Ends the thread and the running load; all requests fail.
  void stop();

  /// Called with the index of the device on the loading thread when a load throws
  /// render::DeviceLost; `take_new_device` must follow. Set before the first load.
  void on_device_loss(std::function<void(std::size_t)> callback) {
    on_device_loss_ = std::move(callback);
  }
  /// The device was recreated: drops the cache of the lost one, and restarts a load that the loss
  /// interrupted.
  void take_new_device(std::size_t device);

  /// Scenes of files that have changed or are gone leave the cache soon, if no session shows them.
  void files_changed() { wake_->notify(); }

  CacheTotals cache_totals() const { return cache_.totals(); }

 private:
  struct Waiter {
    std::shared_ptr<Session> session;
    std::string by;
    Completion done;
    std::string name;                             // of the scene
    std::optional<protocol::EditDocument> edits;  // to show it with
    bool variant = false;                         // of the scene that the session shows
    bool sees_first_view = false;
  };
  struct Job {
    SceneKey key;
    CatalogueEntry entry;
    std::vector<Waiter> waiters;  // guarded by mutex_
    std::stop_source stop;        // requested without waiters, and by stop()
    /// What viewers see meanwhile, or null; guarded by mutex_.
    std::shared_ptr<const render::SceneResources> first_view;
    std::string
        stage;  // of the newest report; this and the rest are used by the loading thread only
    float fraction = 0.0f;
    int device_losses = 0;  // during this load
  };

  static void ask_again(Waiter& waiter, Waiter newer);
  static void join(Waiter& waiter, std::vector<Waiter>& replaced);
  void enqueue(SceneKey key, const CatalogueEntry& entry, Waiter waiter);
  void run();
  std::shared_ptr<Job> next_job();
  std::shared_ptr<Job> first_job();
  void drop(Job& job);
  void run_job(Job& job);
  std::string sessions_of(const Job& job);
  bool wants_first_view(const Job& job);
  void upload_first_view(Job& job, std::unique_ptr<scene::Scene> scene, std::uint64_t image_bytes);
  static void show_first_view(const Job& job, Waiter& waiter);
  static void end_first_view(Waiter& waiter);
  void end_first_views(Job& job);
  LoadedScene load_scene(Job& job);
  LoadedScene import_scene(Job& job, std::vector<scene::SourceFile>& sources);
  void report_device_loss(Job& job);
  static protocol::Result<protocol::SceneInfo> show(const Waiter& waiter,
                                                    const LoadedScene& loaded);
  void finish(Job& job, const protocol::Result<LoadedScene>& outcome);
  std::vector<Waiter> remove_waiters(const std::function<bool(const Session&)>& matches,
                                     const Job* except = nullptr);
  void fail_waiters_of_ended_sessions();
  bool loads_scene(const Session& session) const;
  std::shared_ptr<Job> find_job(const SceneKey& key) const;
  /// Tells all viewers of a session how far the load is that `by` has requested.
  static void send_progress(Session& session, const std::string& by, const std::string& name,
                            std::string_view stage, float fraction, bool first_view = false);
  void report_progress(Job& job, std::string_view stage, float fraction);
  void throw_if_stopped(const Job& job);

  RenderDevices& devices_;
  const SceneCatalogue& catalogue_;
  EnvironmentSource environments_;
  const LoaderOptions options_;
  const std::shared_ptr<WakeEvent> wake_ = std::make_shared<WakeEvent>();  // of the thread
  SceneCache cache_;
  std::function<void(std::size_t)> on_device_loss_;

  std::mutex mutex_;
  std::deque<std::shared_ptr<Job>> jobs_;  // guarded by mutex_, as is the next one
  std::set<std::size_t> lost_devices_;
  bool trim_pending_ = false;  // used by the loading thread only
  std::atomic<bool> stopping_ = false;
  std::thread thread_;
};

}  // namespace heliograph::session
