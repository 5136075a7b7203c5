// Requests for scenes, and what they do to each other.

#include "session/library/scene_loader.hpp"

#include <algorithm>
#include <utility>

#include "session/devices/render_devices.hpp"

namespace heliograph::session {

using protocol::Result;

namespace {

protocol::Error superseded() {
  return protocol::error::conflict("name", "was replaced by a later scene.load");
}

protocol::Error cancelled() {
  return protocol::error::conflict("name", "loading was cancelled");
}

protocol::Error loads_another() {
  return protocol::error::not_ready(
      "a scene is being loaded: its textures can be set when it is shown");
}

protocol::Error file_is_gone(const std::string& scene) {
  return protocol::error::not_found(
      "scene", "the file of " + scene + " is gone: the scene cannot be loaded again");
}

protocol::Error session_ended() {
  return protocol::error::not_found("session", "the session has ended");
}

protocol::Error stopped() {
  return protocol::error::not_ready("the server is shutting down");
}

/// Answers two requests with one outcome.
SceneLoader::Completion in_turn(SceneLoader::Completion first, SceneLoader::Completion then) {
  return [first = std::move(first), then = std::move(then)](auto outcome) {
    first(outcome);
    then(outcome);
  };
}

}  // namespace

SceneLoader::SceneLoader(RenderDevices& devices, const SceneCatalogue& catalogue,
                         LoaderOptions options)
    : devices_(devices),
      catalogue_(catalogue),
      environments_(options.environment),
      options_(std::move(options)),
      cache_(options_.cache_bytes, wake_),
      thread_([this] { run(); }) {}

void SceneLoader::stop() {
  {
    const std::lock_guard lock(mutex_);
    if (stopping_.exchange(true)) return;
    for (const auto& job : jobs_) job->stop.request_stop();
  }
  wake_->notify();
  thread_.join();
  for (const auto& job : std::exchange(jobs_, {})) {
    for (const Waiter& waiter : job->waiters) waiter.done(stopped());
  }
}

void SceneLoader::load(std::shared_ptr<Session> session, const protocol::SceneLoad& request,
                       Textures textures, const std::string& by, Completion done) {
  Result<CatalogueEntry> entry = catalogue_.find(request.name);
  if (!entry) return done(entry.error());
  SceneKey key{.file = entry->path,
               .choice = {request.scene.value_or(""), request.variant.value_or("")},
               .environment = environments_.path_for(*entry).value_or(""),
               .device = session->device(),
               .textures = std::move(textures)};
  enqueue(std::move(key), *entry,
          {std::move(session), by, std::move(done), entry->name, request.edits});
}

void SceneLoader::load_textures(std::shared_ptr<Session> session, Textures textures,
                                std::optional<protocol::EditDocument> edits, const std::string& by,
                                Completion done) {
  const auto shown = session->scene().shown();
  if (!shown) return done(shown.error());
  const auto entry = catalogue_.find(shown->name);
  if (!entry) return done(file_is_gone(shown->name));
  SceneKey key{.file = entry->path,
               .choice = shown->scene->choice,
               .environment = environments_.path_for(*entry).value_or(""),
               .device = session->device(),
               .textures = std::move(textures)};
  enqueue(std::move(key), *entry,
          {std::move(session), by, std::move(done), entry->name, std::move(edits), true});
}

std::optional<SceneLoader::Textures> SceneLoader::pending_textures(const Session& session) {
  const std::lock_guard lock(mutex_);
  for (const auto& job : jobs_) {
    for (const Waiter& waiter : job->waiters) {
      if (waiter.variant && waiter.session.get() == &session) return job->key.textures;
    }
  }
  return std::nullopt;
}

/// Starts the load, joins the one of the same scene, or shows it at once from the cache.
void SceneLoader::enqueue(SceneKey key, const CatalogueEntry& entry, Waiter waiter) {
  std::vector<Waiter> replaced;
  std::optional<LoadedScene> cached;
  std::optional<Result<protocol::SceneInfo>> shown;
  {
    std::unique_lock lock(mutex_);
    if (stopping_) return waiter.done(stopped());
    if (waiter.variant && loads_scene(*waiter.session)) {
      lock.unlock();
      return waiter.done(loads_another());
    }
    std::shared_ptr<Job> job = find_job(key);
    replaced =
        remove_waiters([&](const Session& own) { return &own == waiter.session.get(); }, job.get());
    join(waiter, replaced);
    if (!job) cached = cache_.find(key);
    if (job || cached) {
      cache_.count_hit();
    } else {
      cache_.count_miss();
      job = jobs_.emplace_back(std::make_shared<Job>());
      job->key = std::move(key);
      job->entry = entry;
    }
    if (cached) {
      shown = show(waiter, *cached);
    } else {
      const auto own = std::ranges::find_if(job->waiters, [&](const Waiter& other) {
        return other.session == waiter.session && other.variant == waiter.variant;
      });
      if (own != job->waiters.end()) {
        ask_again(*own, std::move(waiter));
      } else {
        if (job->first_view) show_first_view(*job, waiter);
        job->waiters.push_back(std::move(waiter));
      }
    }
  }
  wake_->notify();
  for (const Waiter& other : replaced) other.done(superseded());
  if (shown) waiter.done(*std::move(shown));
}

/// A session that asks again for what is being loaded is shown it once, as asked for last.
void SceneLoader::ask_again(Waiter& waiter, Waiter newer) {
  newer.sees_first_view = waiter.sees_first_view;
  if (newer.variant && !newer.edits) newer.edits = std::move(waiter.edits);
  newer.done = in_turn(std::move(waiter.done), std::move(newer.done));
  waiter = std::move(newer);
}

/// Other textures add up: requests for them that this one replaces are answered with it.
void SceneLoader::join(Waiter& waiter, std::vector<Waiter>& replaced) {
  if (!waiter.variant) return;
  for (Waiter& other : replaced) {
    if (!other.variant) continue;
    if (!waiter.edits) waiter.edits = std::move(other.edits);
    waiter.done = in_turn(std::move(other.done), std::move(waiter.done));
  }
  std::erase_if(replaced, [](const Waiter& other) { return other.variant; });
}

protocol::SceneCancelled SceneLoader::cancel(const Session& session) {
  std::vector<Waiter> removed;
  {
    const std::lock_guard lock(mutex_);
    removed = remove_waiters([&](const Session& own) { return &own == &session; });
  }
  for (const Waiter& waiter : removed) {
    send_progress(*waiter.session, waiter.by, waiter.name, "cancelled", 0.0f);
    waiter.done(cancelled());
  }
  return {.cancelled = !removed.empty()};
}

/// Removes the waiters of such sessions from all jobs but `except`; a job without waiters is
/// cancelled.
std::vector<SceneLoader::Waiter> SceneLoader::remove_waiters(
    const std::function<bool(const Session&)>& matches, const Job* except) {
  std::vector<Waiter> removed;
  for (const auto& job : jobs_) {
    if (job.get() == except) continue;
    const auto own =
        std::stable_partition(job->waiters.begin(), job->waiters.end(),
                              [&](const Waiter& waiter) { return !matches(*waiter.session); });
    std::for_each(own, job->waiters.end(), end_first_view);
    removed.insert(removed.end(), std::make_move_iterator(own),
                   std::make_move_iterator(job->waiters.end()));
    job->waiters.erase(own, job->waiters.end());
    if (job->waiters.empty()) job->stop.request_stop();
  }
  std::erase_if(jobs_, [](const auto& job) { return job->stop.stop_requested(); });
  return removed;
}

/// Called often, by the loading thread: sessions end without telling the loader.
void SceneLoader::fail_waiters_of_ended_sessions() {
  std::vector<Waiter> removed;
  {
    const std::lock_guard lock(mutex_);
    removed = remove_waiters([](const Session& own) { return own.ended(); });
  }
  for (const Waiter& waiter : removed) waiter.done(session_ended());
}

/// Whether it waits for a scene, and not only for other textures of the one that it shows.
bool SceneLoader::loads_scene(const Session& session) const {
  return std::ranges::any_of(jobs_, [&](const auto& job) {
    return std::ranges::any_of(job->waiters, [&](const Waiter& waiter) {
      return !waiter.variant && waiter.session.get() == &session;
    });
  });
}

std::shared_ptr<SceneLoader::Job> SceneLoader::find_job(const SceneKey& key) const {
  const auto found = std::ranges::find_if(jobs_, [&](const auto& job) { return job->key == key; });
  return found == jobs_.end() ? nullptr : *found;
}

}  // namespace heliograph::session
