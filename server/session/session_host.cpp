#include "session/session_host.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <exception>
#include <string>
#include <string_view>
#include <utility>

#include "jobs/job_queue.hpp"
#include "session/commands/commands.hpp"
#include "session/edits/edited_parts.hpp"
#include "session/edits/texture_edits.hpp"
#include "session/library/upload_store.hpp"

namespace heliograph::session {

using protocol::Result;

namespace {

constexpr std::chrono::seconds pause_after_failure{1};

// Thumbnails of scenes.
constexpr std::uint32_t thumbnail_width = 240;
constexpr std::uint32_t thumbnail_height = 135;
constexpr std::uint32_t thumbnail_samples = 8;
constexpr std::uint32_t thumbnail_timeout = 60;  // seconds
/// The server is idle after so long without a frame, or, while views refine, without motion.
constexpr std::chrono::seconds idle_period{1};
constexpr std::chrono::seconds still_period{20};

/// The error of a nested request, with the name of its member in the outer request.
protocol::Error renamed(const protocol::Error& part, std::string_view path, std::string name) {
  if (part.path != path) return part;
  return protocol::error::make(part.code, std::move(name), part.reason, part.limit);
}

const std::filesystem::path& root_of(const UploadRoots& roots, UploadKind kind) {
  if (kind == UploadKind::scene) return roots.scenes;
  return kind == UploadKind::environment ? roots.environments : roots.images;
}

/// Whether the caller has control of what the method changes: of the session, or of its camera
/// where that is the viewer's own; who may annotate is the server's choice.
Result<void> may_change(const Session& session, const protocol::MethodDescriptor& method,
                        const protocol::CallContext& call, protocol::Annotators annotators) {
  const bool own_view = !session.follows().empty() && !call.viewer.empty();
  const bool moves = method.call == protocol::Call::movement;
  if (own_view && moves) return {};
  if (method.call == protocol::Call::annotation && session.follows().empty() &&
      annotators == protocol::Annotators::everyone) {
    return {};
  }
  if (call.view_only) return protocol::read_only_token();
  if (!session.follows().empty() && !moves) {
    return protocol::error::make(
        protocol::ErrorCode::forbidden, "session",
        "follows the session " + session.follows() + "; only its camera can be changed");
  }
  if (!session.viewers().may_change(call.viewer)) return no_control(session.viewers());
  return {};
}

}  // namespace

std::vector<std::filesystem::path> HostOptions::all_environment_roots() const {
  std::vector<std::filesystem::path> roots = scene_roots;
  roots.insert(roots.end(), environment_roots.begin(), environment_roots.end());
  return roots;
}

SessionHost::SessionHost(const render::Engines& engines, HostOptions options)
    : options_(std::move(options)),
      catalogue_(options_.scene_roots),
      images_(options_.image_roots),
      devices_(engines, options_.release_after),
      sessions_(
          options_.limits, options_.session,
          [this](SessionOptions session, PixelShare pixels) {
            return devices_.open(std::move(session), std::move(pixels));
          },
          [this](const Session& session) { devices_.close(session); }),
      dispatcher_(options_.dispatch),
      loader_(devices_, catalogue_,
              {.environment = options_.environment,
               .limits = options_.import_limits,
               .cache_bytes = options_.scene_cache_bytes}),
      environments_(devices_, SceneCatalogue(options_.all_environment_roots())),
      thumbnails_(catalogue_, options_.thumbnail_folder,
                  [this](const std::string& scene, SceneThumbnails::Rendered done) {
                    render_thumbnail(scene, std::move(done));
                  }),
      exporter_(options_.import_limits) {
  const auto report_loss = [this](std::size_t device) {
    devices_.loop(device).report_device_loss();
  };
  loader_.on_device_loss(report_loss);
  environments_.on_device_loss(report_loss);
  for (std::size_t i = 0; i < devices_.count(); ++i) {
    devices_.loop(i).on_new_device([this, i] { loader_.take_new_device(i); });
  }
  add_session_commands(dispatcher_, *this);
  add_scene_commands(dispatcher_, *this);
  add_camera_commands(dispatcher_, *this);
  add_animation_commands(dispatcher_, *this);
  add_settings_commands(dispatcher_, *this);
  add_stream_commands(dispatcher_, *this);
  add_stats_commands(dispatcher_, *this);
  add_capture_commands(dispatcher_, *this);
  add_frame_commands(dispatcher_, *this);
  add_edit_commands(dispatcher_, *this);
  add_texture_commands(dispatcher_, *this);
  add_probe_commands(dispatcher_, *this);
  add_job_commands(dispatcher_, *this);
  dispatcher_.set_gate([this](const protocol::MethodDescriptor& method,
                              const protocol::CallContext& call) -> protocol::Result<void> {
    const auto session = sessions_.session_of(call);
    if (!session) return session.error();
    (*session)->mark_used();
    if (!method.needs_control()) return {};
    if (const auto may = may_change(**session, method, call, options_.annotators); !may) return may;
    (*session)->mark_modified();
    return {};
  });
  dispatcher_.on_handler_failure([](std::string_view method, std::string_view reason) {
    spdlog::error("{} failed: {}", method, reason);
  });
  idle_thread_ = std::thread([this] { work_when_idle(); });
  if (options_.jobs) follow_jobs();
}

/// Tells every viewer of every session; a newer state of a job replaces one that is queued.
void SessionHost::follow_jobs() {
  options_.jobs->on_change([this](const protocol::JobInfo& job) {
    const std::string text = protocol::make_notification<protocol::notifications::job_changed>(job);
    const std::string key = "job.changed " + job.job;
    for (const auto& session : sessions_.all()) session->viewers().send_all(text, key);
  });
  options_.jobs->pause_while([this] { return devices_.images_move(); });
  options_.jobs->start();
}

void SessionHost::work_when_idle() {
  while (!stopping_) {
    Clock::duration next = pause_after_failure;
    try {
      next = do_idle_work();
    } catch (const std::exception& failure) {
      spdlog::error("idle sessions were not closed: {}", failure.what());
    }
    idle_check_.wait_until(Clock::now() + next);
  }
}

/// Closes sessions without use, and renders thumbnails where nothing else is to be done. Gives
/// the time until there may be more to do: no less than what shows that the server is idle.
Clock::duration SessionHost::do_idle_work() {
  const Clock::duration next = sessions_.close_idle();
  if (!thumbnails_.has_work()) return next;
  if (is_idle()) thumbnails_.render_next();
  return std::min<Clock::duration>(next, idle_period);
}

/// Whether no session has had a frame since this was asked last, nor is to have one that takes
/// longer, or nothing has moved for long.
bool SessionHost::is_idle() {
  const std::uint64_t frames = devices_.totals().frames.count();
  const bool idle = std::exchange(frames_before_, frames) == frames && !devices_.are_occupied();
  return ready() && (idle || devices_.still_for() >= still_period);
}

Result<SceneThumbnails::File> SessionHost::scene_thumbnail(const std::string& scene) {
  Result<SceneThumbnails::File> found = thumbnails_.get(scene);
  if (thumbnails_.has_work()) idle_check_.notify();
  return found;
}

bool SessionHost::was_uploaded(UploadKind kind, const CatalogueEntry& entry) const {
  // The studio has no root, as uploads have none where they are not allowed.
  return !entry.root.empty() && entry.root == root_of(options_.upload_roots, kind) &&
         is_upload(entry);
}

Result<void> SessionHost::delete_upload(UploadStore& uploads, UploadKind kind,
                                        const std::string& name) {
  std::optional<CatalogueEntry> scene;
  if (kind == UploadKind::scene) scene = catalogue_.find_in_root(name);
  // Before the file goes, from which it follows. It is forgotten after that: until then it could
  // be asked for and rendered again.
  std::filesystem::path image;
  if (scene && was_uploaded(kind, *scene)) image = thumbnails_.file_of(*scene);
  if (const Result<void> removed = uploads.remove(kind, name); !removed) return removed;
  if (!image.empty()) thumbnails_.forget(image);
  if (kind == UploadKind::environment) environments_.forget_thumbnail(name);
  uploads_changed({.kind = kind, .name = name, .deleted = true});
  return {};
}

/// Those of several files are all sent; a newer change of a file replaces one that is queued.
void SessionHost::uploads_changed(const protocol::UploadsChanged& change) {
  using Notification = protocol::notifications::uploads_changed;
  loader_.files_changed();
  const std::string text = protocol::make_notification<Notification>(change);
  const std::string key =
      fmt::format("{} {} {}", Notification::name, protocol::enum_name(change.kind), change.name);
  for (const auto& session : sessions_.all()) session->viewers().send_all(text, key);
}

/// In a session of its own, which opens the scene as any other does.
void SessionHost::render_thumbnail(const std::string& scene, SceneThumbnails::Rendered done) {
  protocol::SessionCreate request;
  request.scene = scene;
  request.width = thumbnail_width;
  request.height = thumbnail_height;
  request.idle_timeout = thumbnail_timeout;
  create_session(request, {}, [this, done](const Result<std::shared_ptr<Session>>& created) {
    if (!created) return done(created.error());
    const std::shared_ptr<Session> session = *created;
    CaptureRequest capture{.format = protocol::ImageFormat::jpeg, .samples = thumbnail_samples};
    capture.done = [this, done, weak = std::weak_ptr(session)](Result<Capture> result) {
      const auto rendered = weak.lock();
      if (rendered && !rendered->ended()) {
        (void)sessions_.close(rendered->name(), "its thumbnail was rendered");
      }
      if (!result) return done(result.error());
      done(std::move(result->file));
    };
    const auto accepted = session->captures().request_capture(std::move(capture));
    if (accepted) return;
    if (!session->ended()) (void)sessions_.close(session->name(), accepted.error().message);
    done(accepted.error());
  });
}

SessionHost::~SessionHost() {
  stop();
}

void SessionHost::stop() {
  if (options_.jobs) options_.jobs->stop();
  stopping_ = true;
  idle_check_.notify();
  if (idle_thread_.joinable()) idle_thread_.join();
  loader_.stop();
  environments_.stop();
  exporter_.stop();
  devices_.stop();
}

void SessionHost::create_session(const protocol::SessionCreate& request, const std::string& by,
                                 Created done, std::optional<std::size_t> device) {
  SessionOptions options = options_.session;
  options.device = device;
  options.name = request.name.value_or("");
  std::shared_ptr<Session> model = sessions_.main();
  if (request.copy_of) {
    const auto original = sessions_.find(*request.copy_of);
    if (!original) return done(protocol::error::not_found("copy_of", original.error().reason));
    model = *original;
    const protocol::SessionInfo info = model->info({});
    options.width = info.width;
    options.height = info.height;
  }
  options.limits.idle_timeout = std::chrono::seconds(request.idle_timeout.value_or(0));
  options.width = request.width.value_or(options.width);
  options.height = request.height.value_or(options.height);
  const auto created = sessions_.create(std::move(options));
  if (!created) return done(created.error());
  idle_check_.notify();
  const std::shared_ptr<Session>& session = *created;
  session->set_buffers(model->buffers());
  if (request.copy_of) session->copy_from(*model);
  if (request.settings) {
    const auto patched = session->patch_settings(*request.settings, by);
    if (!patched)
      return fail_creation(session, renamed(patched.error(), "patch", "settings"), done);
  }
  if (!request.scene) return done(session);
  load_scene(session, {.name = *request.scene}, by,
             [this, session, done](const Result<protocol::SceneInfo>& loaded) {
               if (loaded) return done(session);
               fail_creation(session, renamed(loaded.error(), "name", "scene"), done);
             });
}

Result<std::shared_ptr<Session>> SessionHost::detach(const std::string& viewer) {
  const std::shared_ptr<Session> leader = sessions_.session_of_viewer(viewer);
  if (!leader) return protocol::error::not_ready("requires a WebSocket connection");
  const protocol::SessionInfo info = leader->info({});
  SessionOptions options = options_.session;
  options.width = info.width;
  options.height = info.height;
  options.device = leader->device();  // they share what is on it
  return sessions_.detach(viewer, std::move(options));
}

Result<Resumed> SessionHost::resume(const std::string& viewer, const Origin& from, bool read_only) {
  if (read_only) return sessions_.resume(viewer, from, std::nullopt);
  const auto resumed = sessions_.resume(viewer, from, options_.session);
  if (resumed) resumed->session->set_buffers(sessions_.main()->buffers());
  return resumed;
}

/// A session that cannot be created as requested is closed before any client has used it.
void SessionHost::fail_creation(const std::shared_ptr<Session>& session, const protocol::Error& why,
                                const Created& done) {
  // Another client may have closed it already, and created another of its name.
  if (!session->ended()) (void)sessions_.close(session->name(), why.message);
  done(why);
}

void SessionHost::load_scene(std::shared_ptr<Session> session, const protocol::SceneLoad& request,
                             const std::string& by, SceneLoader::Completion done) {
  const auto textures = overrides_of(request.edits.value_or(protocol::EditDocument()), images_);
  if (!textures) return done(textures.error());
  if (!request.edits || !request.edits->environment || !request.edits->environment->name) {
    return loader_.load(std::move(session), request, *textures, by, std::move(done));
  }
  const std::string name = *request.edits->environment->name;
  if (const auto known = environments_.find(name); !known) {
    return done(below(known.error(), "edits.environment"));
  }
  loader_.load(session, request, *textures, by, [this, session, name, by, done](auto loaded) {
    if (!loaded) return done(loaded.error());
    environments_.show(session, name, by, [done, loaded](Result<void> outcome) {
      done(outcome ? loaded : below(outcome.error(), "edits.environment"));
    });
  });
}

void SessionHost::set_texture(const std::shared_ptr<Session>& session,
                              const protocol::TextureSet& request, const std::string& by,
                              protocol::Completion<protocol::TextureState> done) {
  // First: what was pending may be shown by then.
  const auto pending = loader_.pending_textures(*session);
  const auto shown = session->scene().shown();
  if (!shown) return done(shown.error());
  const auto slot = check_slot(*shown->scene, request.material, request.slot);
  if (!slot) return done(slot.error());
  const auto textures =
      with_change(pending ? *pending : overrides_of(*shown->scene), request, images_);
  if (!textures) return done(textures.error());
  loader_.load_textures(session, *textures, std::nullopt, by,
                        [session, request, done = std::move(done)](const auto& loaded) {
                          if (!loaded) return done(renamed(loaded.error(), "name", "image"));
                          done(session->scene().texture(request.material, request.slot));
                        });
}

void SessionHost::apply_edits(const std::shared_ptr<Session>& session,
                              const protocol::EditDocument& document, const std::string& by,
                              std::function<void(Result<void>)> done) {
  // First: what was pending may be shown by then.
  const auto pending = loader_.pending_textures(*session);
  const auto shown = session->scene().shown();
  if (!shown) return done(shown.error());
  const auto fit = check_slots(*shown->scene, document);
  if (!fit) return done(fit.error());
  if (!pending && has_textures(*shown->scene, document)) {
    return done(session->scene().apply_edits(document, by));
  }
  const auto textures = overrides_of(document, images_);
  if (!textures) return done(textures.error());
  if (*textures == overrides_of(*shown->scene) && !pending) {
    return done(session->scene().apply_edits(document, by));
  }
  loader_.load_textures(session, *textures, document, by,
                        [done = std::move(done)](const auto& loaded) {
                          if (!loaded)
                            return done(renamed(loaded.error(), "name", "edits.textures"));
                          done({});
                        });
}

void SessionHost::on_first_frame(std::function<void()> callback) {
  devices_.on_first_frame(std::move(callback));
}

}  // namespace heliograph::session
