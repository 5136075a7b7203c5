// The loading thread: imports scenes, uploads them and shows them to the sessions that wait.

#include <fmt/format.h>
#include <malloc.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "protocol/json/jsonrpc.hpp"
#include "protocol/json/suggestions.hpp"
#include "render/api/device_lost.hpp"
#include "render/api/kept_textures.hpp"
#include "render/api/renderer.hpp"
#include "session/devices/render_devices.hpp"
#include "session/event_log.hpp"
#include "session/library/scene_description.hpp"
#include "session/library/scene_loader.hpp"

namespace heliograph::session {

using protocol::Result;

namespace {

/// Fraction of the import in the progress; the rest is upload and acceleration structure.
constexpr float import_fraction = 0.7f;
/// What is done of that when the scene can be shown without its textures, about.
constexpr float first_view_fraction = 0.2f;
/// Progress between two reports of one stage.
constexpr float report_step = 0.01f;
/// How long after a load its temporary memory is returned, since the first frames leave some
/// behind, too.
constexpr std::chrono::seconds trim_delay{2};
/// The scene may cause the loss of the device, so the number of tries is limited.
constexpr int max_device_losses = 3;

/// Whether viewers may see the scene before it is complete: programs that step through frames or
/// render a reference do not.
bool may_see_first_view(const Session& session) {
  return session.viewers().has_active_viewer() && !session.renders_without_viewers();
}

/// Whether rays look up textures: then the acceleration structure is built again.
bool has_masks(const scene::Scene& scene) {
  constexpr std::uint32_t partial = shared::material_alpha_mask | shared::material_alpha_blend;
  return std::ranges::any_of(scene.materials, [](const shared::Material& material) {
    return (material.flags & partial) != 0;
  });
}

protocol::Error no_such(const scene::NoSuchChoice& failure, const scene::SceneChoice& choice) {
  const std::string& requested = failure.member() == "scene" ? choice.scene : choice.variant;
  const std::vector<std::string_view> names(failure.names().begin(), failure.names().end());
  return protocol::error::not_found(failure.member(),
                                    "is not in the file" + protocol::suggestion(requested, names));
}

/// Of an edit document: other textures are checked before they are asked for.
protocol::Error no_such(const scene::NoSuchSlot& failure) {
  const std::vector<std::string_view> names(failure.names().begin(), failure.names().end());
  return protocol::error::not_found(
      "edits.textures", "the scene has no " + failure.member() + " " + failure.requested() +
                            protocol::suggestion(failure.requested(), names));
}

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Decoded images and meshes of a load leave free memory between live allocations, which glibc
/// keeps unless it is trimmed: a third of the server's memory after a large scene.
void return_free_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

}  // namespace

void SceneLoader::run() {
  while (!stopping_) {
    std::shared_ptr<Job> job;
    try {
      job = next_job();
      if (!job) return;
      fail_waiters_of_ended_sessions();
      if (!job->stop.stop_requested()) run_job(*job);
    } catch (const std::exception& failure) {
      // There is no memory to tell those who wait; their calls are answered when the job is freed.
      spdlog::error("the scene loader: {}", failure.what());
      if (job) drop(*job);
    }
    trim_pending_ = true;
  }
}

void SceneLoader::drop(Job& job) {
  const std::lock_guard lock(mutex_);
  std::ranges::for_each(job.waiters, end_first_view);
  job.waiters.clear();
  std::erase_if(jobs_, [&](const auto& other) { return other.get() == &job; });
}

/// Waits for a job, and trims cache and memory while there is none; null on shutdown.
std::shared_ptr<SceneLoader::Job> SceneLoader::next_job() {
  std::optional<Clock::time_point> trim_at;
  while (!stopping_) {
    if (auto job = first_job()) return job;
    cache_.trim();
    if (std::exchange(trim_pending_, false)) trim_at = Clock::now() + trim_delay;
    wake_->wait_until(trim_at);
    if (trim_at && Clock::now() >= *trim_at) {
      return_free_memory();
      trim_at.reset();
    }
  }
  return nullptr;
}

/// On a device that is not lost.
std::shared_ptr<SceneLoader::Job> SceneLoader::first_job() {
  const std::lock_guard lock(mutex_);
  const auto found = std::ranges::find_if(
      jobs_, [&](const auto& job) { return !lost_devices_.contains(job->key.device); });
  return found == jobs_.end() ? nullptr : *found;
}

void SceneLoader::run_job(Job& job) {
  const Clock::time_point start = Clock::now();
  try {
    const LoadedScene loaded = load_scene(job);
    log_info({.session = sessions_of(job)},
             fmt::format("{} loaded in {:.2f} s, {} triangles, {} MiB", job.entry.name,
                         seconds_since(start), loaded.scene->triangle_count(),
                         (loaded.host_bytes + loaded.device_bytes) >> 20));
    finish(job, loaded);
  } catch (const scene::LoadCancelled&) {
    log_info({}, fmt::format("loading {} was cancelled after {:.2f} s", job.entry.name,
                             seconds_since(start)));
  } catch (const scene::NoSuchChoice& failure) {
    finish(job, no_such(failure, job.key.choice));
  } catch (const scene::NoSuchSlot& failure) {
    finish(job, no_such(failure));
  } catch (const scene::ImportError& failure) {
    finish(job,
           protocol::error::invalid("name", "cannot be loaded: " + std::string(failure.what())));
  } catch (const render::DeviceLost& failure) {
    log_error({.session = sessions_of(job)},
              fmt::format("loading {}: {}", job.entry.name, failure.what()));
    report_device_loss(job);
  } catch (const std::exception& failure) {
    log_error({.session = sessions_of(job)},
              fmt::format("loading {}: {}", job.entry.name, failure.what()));
    finish(job, protocol::error::internal());
  }
}

/// The names of all sessions that wait for it.
std::string SceneLoader::sessions_of(const Job& job) {
  const std::lock_guard lock(mutex_);
  std::string names;
  for (const Waiter& waiter : job.waiters) {
    names += (names.empty() ? "" : " ") + waiter.session->name();
  }
  return names;
}

/// The job stays and runs again on the recovered device.
void SceneLoader::report_device_loss(Job& job) {
  {
    const std::lock_guard lock(mutex_);
    // Before the report: the device may be recovered at once.
    lost_devices_.insert(job.key.device);
  }
  end_first_views(job);
  if (on_device_loss_) on_device_loss_(job.key.device);
  if (++job.device_losses == max_device_losses) {
    finish(job,
           protocol::error::not_ready("the device was lost repeatedly while loading this scene"));
  }
}

void SceneLoader::take_new_device(std::size_t device) {
  cache_.clear(device);
  {
    const std::lock_guard lock(mutex_);
    lost_devices_.erase(device);
  }
  wake_->notify();
}

/// Another device that has the scene spares the import.
LoadedScene SceneLoader::load_scene(Job& job) {
  DeviceMigration& migration = devices_.loop(job.key.device).migration();
  std::vector<scene::SourceFile> sources;
  LoadedScene loaded;
  if (auto elsewhere = cache_.find_elsewhere(job.key)) {
    report_progress(job, "uploading", import_fraction);
    loaded = std::move(elsewhere->scene);
    sources = std::move(elsewhere->sources);
    loaded.resources = migration(loaded.resources);
  } else {
    loaded = import_scene(job, sources);
    migration.add(loaded.resources);
  }
  throw_if_stopped(job);
  loaded.device_bytes = render::memory_bytes(*loaded.resources);
  return cache_.add(job.key, std::move(loaded), std::move(sources));
}

LoadedScene SceneLoader::import_scene(Job& job, std::vector<scene::SourceFile>& sources) {
  const auto checkpoint = [&](std::string_view stage, float fraction) {
    throw_if_stopped(job);
    report_progress(job, stage, fraction);
  };
  if (!job.key.environment.empty()) sources.push_back(scene::examine_file(job.key.environment));
  checkpoint("reading", 0.0f);
  render::Engine& engine = devices_.engine(job.key.device);
  scene::ImportOptions options{
      .choice = job.key.choice,
      .progress = [&](std::string_view stage,
                      float fraction) { checkpoint(stage, import_fraction * fraction); },
      .stop = job.stop.get_token(),
      .kept_textures = render::kept_textures(engine),
      .textures = job.key.textures};
  if (wants_first_view(job)) {
    options.untextured = [&](std::unique_ptr<scene::Scene> scene, std::uint64_t image_bytes) {
      upload_first_view(job, std::move(scene), image_bytes);
    };
    options.untextured_from = options_.first_view_bytes;
  }
  auto imported =
      std::make_unique<scene::Scene>(scene::import_gltf(job.entry.path, options_.limits, options));
  sources.insert(sources.end(), imported->sources.begin(), imported->sources.end());
  LoadedScene loaded{.name = job.entry.name};
  loaded.environment =
      (environments_.is_lit_by_its_file(*imported) ? job.entry.path : job.key.environment)
          .filename()
          .string();
  auto environment = environments_.environment_of(*imported, job.key.environment);
  loaded.resources = engine.upload_and_free_pixels(
      std::move(imported), std::move(environment),
      [&](std::string_view stage, float fraction) {
        checkpoint(stage, import_fraction + (1.0f - import_fraction) * fraction);
      },
      job.first_view);
  loaded.scene = render::scene_of(*loaded.resources);
  loaded.host_bytes = loaded.scene->bytes();
  return loaded;
}

/// Whether a session that waits for it has viewers to whom its geometry can be shown alone. What
/// edits hide and change would show.
bool SceneLoader::wants_first_view(const Job& job) {
  const std::lock_guard lock(mutex_);
  return std::ranges::any_of(job.waiters, [](const Waiter& waiter) {
    return !waiter.edits && !waiter.variant && may_see_first_view(*waiter.session);
  });
}

/// Not where a second acceleration structure would take much of the scene's memory.
void SceneLoader::upload_first_view(Job& job, std::unique_ptr<scene::Scene> scene,
                                    std::uint64_t image_bytes) {
  if (has_masks(*scene) && image_bytes < scene->bytes()) return;
  auto environment = environments_.environment_of(*scene, job.key.environment);
  auto uploaded = devices_.engine(job.key.device)
                      .upload(std::shared_ptr<const scene::Scene>(std::move(scene)),
                              std::move(environment), [&](std::string_view stage, float) {
                                throw_if_stopped(job);
                                report_progress(job, stage, import_fraction * first_view_fraction);
                              });
  throw_if_stopped(job);
  const std::lock_guard lock(mutex_);
  job.first_view = std::move(uploaded);
  for (Waiter& waiter : job.waiters) show_first_view(job, waiter);
}

void SceneLoader::show_first_view(const Job& job, Waiter& waiter) {
  if (waiter.edits || waiter.variant || !may_see_first_view(*waiter.session)) return;
  waiter.session->scene().show_first_view(render::scene_of(*job.first_view), job.first_view,
                                          waiter.by);
  waiter.sees_first_view = true;
  // With the camera: pages tell it by this from a camera that another viewer has moved.
  send_progress(*waiter.session, waiter.by, job.entry.name, "textures",
                import_fraction * first_view_fraction, true);
}

void SceneLoader::end_first_view(Waiter& waiter) {
  if (std::exchange(waiter.sees_first_view, false)) waiter.session->scene().end_first_view();
}

void SceneLoader::end_first_views(Job& job) {
  const std::lock_guard lock(mutex_);
  std::ranges::for_each(job.waiters, end_first_view);
  job.first_view = nullptr;
}

/// The answer to the request; its edits may not fit the scene.
Result<protocol::SceneInfo> SceneLoader::show(const Waiter& waiter, const LoadedScene& loaded) {
  SessionScene& scene = waiter.session->scene();
  const Result<void> shown =
      waiter.variant
          ? scene.show_variant(loaded, waiter.edits, waiter.by)
          : scene.show(loaded, waiter.edits.value_or(protocol::EditDocument()), waiter.by);
  send_progress(*waiter.session, waiter.by, loaded.name, shown ? "ready" : "failed",
                shown ? 1.0f : 0.0f);
  if (!shown) return shown.error();
  return describe_scene(loaded);
}

/// Shows the scene in every session that waits for it, and answers the requests.
void SceneLoader::finish(Job& job, const Result<LoadedScene>& outcome) {
  std::vector<Waiter> waiters;
  std::vector<Result<protocol::SceneInfo>> answers;
  {
    const std::lock_guard lock(mutex_);
    waiters = std::exchange(job.waiters, {});
    std::erase_if(jobs_, [&](const auto& other) { return other.get() == &job; });
    for (Waiter& waiter : waiters) {
      answers.push_back(outcome ? show(waiter, *outcome) : outcome.error());
      if (!answers.back()) end_first_view(waiter);
    }
  }
  for (std::size_t i = 0; i < waiters.size(); ++i) {
    const Waiter& waiter = waiters[i];
    if (outcome) {
      waiter.done(std::move(answers[i]));
    } else {
      log_warning({.session = waiter.session->name()},
                  job.entry.name + " was not loaded: " + outcome.error().message);
      send_progress(*waiter.session, waiter.by, job.entry.name, "failed", 0.0f);
      waiter.done(outcome.error());
    }
  }
}

void SceneLoader::send_progress(Session& session, const std::string& by, const std::string& name,
                                std::string_view stage, float fraction, bool first_view) {
  session.viewers().send_all(protocol::make_notification<protocol::notifications::scene_progress>(
                                 {.name = name,
                                  .stage = std::string(stage),
                                  .fraction = fraction,
                                  .first_view = first_view,
                                  .by = by}),
                             protocol::notifications::scene_progress::name);
}

void SceneLoader::report_progress(Job& job, std::string_view stage, float fraction) {
  if (stage == job.stage && fraction < job.fraction + report_step) return;
  job.stage = stage;
  job.fraction = fraction;
  const std::lock_guard lock(mutex_);
  for (const Waiter& waiter : job.waiters) {
    send_progress(*waiter.session, waiter.by, job.entry.name, stage, fraction,
                  waiter.sees_first_view);
  }
}

void SceneLoader::throw_if_stopped(const Job& job) {
  fail_waiters_of_ended_sessions();
  scene::throw_if_cancelled(job.stop.get_token());
}

}  // namespace heliograph::session
