#include "session/state/session.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <tuple>
#include <utility>

#include "protocol/json/jsonrpc.hpp"
#include "protocol/settings/settings_json.hpp"
#include "render/api/buffer_names.hpp"
#include "scene/animation/pose.hpp"
#include "scene/camera.hpp"
#include "session/library/scene_description.hpp"
#include "session/measurements.hpp"
#include "session/rendering/device_migration.hpp"

namespace heliograph::session {

using protocol::Result;
namespace error = protocol::error;

protocol::Error no_control(const ViewerSet& audience) {
  if (audience.control_is_free()) {
    return error::make(protocol::ErrorCode::forbidden, "control",
                       "no viewer has control of this session; take control first",
                       "session.control with the action take");
  }
  return error::make(protocol::ErrorCode::forbidden, "control",
                     "another viewer has control of this session", "session.control");
}

Session::Session(SessionOptions options, std::shared_ptr<WakeEvent> changed, PixelShare pixels,
                 Measurements* measurements)
    : options_(std::move(options)),
      changed_(std::move(changed)),
      measurements_(measurements),
      viewers_(options_.limits.max_viewers, *changed_),
      pixels_(std::move(pixels)) {
  state_.settings = options_.settings;
  state_.width = std::min(options_.width, options_.limits.max_width);
  state_.height = std::min(options_.height, options_.limits.max_height);
  state_.rev = 1;
  state_.version = 1;
  state_.changed_at = Clock::now();
}

std::uint32_t Session::rev() const {
  const std::lock_guard lock(mutex_);
  return state_.rev;
}

protocol::SessionInfo Session::info(const std::string& you) const {
  const std::lock_guard lock(mutex_);
  protocol::SessionInfo info = info_locked();
  info.viewers = viewers_.participants(you);
  return info;
}

void Session::announce() {
  // Under the lock, so that nobody hears the older of two states last.
  const std::lock_guard lock(mutex_);
  viewers_.announce_participants(info_locked());
}

protocol::SessionInfo Session::info_locked() const {
  protocol::SessionInfo info{.name = options_.name,
                             .scene = std::nullopt,
                             .width = state_.width,
                             .height = state_.height,
                             .viewers = {},
                             .control = viewers_.control_mode(),
                             .rev = state_.rev,
                             .idle_seconds = std::chrono::duration<double>(idle()).count()};
  if (scene_) info.scene = scene_info_.name;
  return info;
}

bool Session::renders_without_viewers() const {
  const std::lock_guard lock(mutex_);
  return state_.lockstep || state_.keep_drawing;
}

bool Session::is_pristine(const std::string& viewer) const {
  return !touched_ && viewers_.control_mode() == protocol::ControlMode::shared &&
         !viewers_.has_other_participant(viewer);
}

Clock::duration Session::idle() const {
  if (!viewers_.empty()) return {};
  return Clock::now() - needed_at_.load();
}

void Session::end() {
  ended_ = true;
  const std::lock_guard lock(mutex_);
  pixels_.give_back();
}

void Session::copy_from(const Session& other) {
  const std::scoped_lock lock(mutex_, other.mutex_);
  const std::uint64_t version = state_.version;
  const auto [width, height, rev] = std::tuple(state_.width, state_.height, state_.rev);
  state_ = other.state_;
  std::tie(state_.width, state_.height, state_.rev) = std::tie(width, height, rev);
  state_.version = version;
  ++state_.cuts;
  state_.animation = other.rewound_clock();
  state_.animation.since = Clock::now();
  state_.lockstep.reset();
  state_.keep_drawing = false;
  before_reference_ = other.before_reference_;
  edits_ = other.edits_;
  environment_name_ = other.environment_name_;
  camera_name_ = other.camera_name_;
  scene_ = other.scene_;
  scene_info_ = other.scene_info_;
  buffers_ = other.buffers_;
  changed();
}

void Session::set_buffers(std::vector<protocol::BufferInfo> buffers) {
  const std::lock_guard lock(mutex_);
  buffers_ = std::move(buffers);
}

std::vector<protocol::BufferInfo> Session::buffers() const {
  const std::lock_guard lock(mutex_);
  return buffers_;
}

std::uint64_t Session::version() const {
  const std::lock_guard lock(mutex_);
  return state_.version;
}

RenderState Session::render_state() const {
  const std::lock_guard lock(mutex_);
  return whole_state();
}

RenderState Session::whole_state() const {
  RenderState state = state_;
  state.scene = scene_;
  const scene::Clip* const clip =
      scene_ && camera_name_ ? scene::find_clip(*scene_, state_.animation.clip) : nullptr;
  state.camera_follows = clip && scene::carries(*scene_, *clip, state_.camera);
  for (const auto& [viewer, seq] : input_seqs_) {
    state.inputs.push_back({.viewer = viewer, .seq = seq});
  }
  return state;
}

Result<protocol::SceneInfo> Session::scene_info() const {
  const std::lock_guard lock(mutex_);
  if (const Result<void> there = require_scene(); !there) return there.error();
  return scene_info_;
}

void Session::show(LoadedScene scene, const std::string& by) {
  const std::lock_guard lock(mutex_);
  scene_ = scene.scene;
  scene_info_ = describe_scene(scene);
  edits_ = SceneEdits(scene_);
  state_.resources = std::move(scene.resources);
  state_.lights = nullptr;
  state_.materials = nullptr;
  state_.environment = nullptr;
  environment_name_.reset();
  state_.animation = {};
  ++state_.cuts;
  if (scene_->cameras.empty()) {
    state_.camera = scene::fit_camera(scene_->bounds, scene::Camera().vertical_fov, aspect());
    camera_name_.reset();
  } else {
    state_.camera = scene_->cameras.front();
    camera_name_ = state_.camera.name;
  }
  changed();
  viewers_.send_others(
      by,
      protocol::make_notification<protocol::notifications::scene_changed>({.scene = scene_info_}),
      {});
}

protocol::SettingsState Session::settings() const {
  const std::lock_guard lock(mutex_);
  return {.rev = state_.rev, .settings = protocol::RawJson(protocol::to_json(state_.settings))};
}

Result<protocol::SettingsApplied> Session::patch_settings(const protocol::RawJson& patch,
                                                          const std::string& by) {
  const std::lock_guard lock(mutex_);
  return patch_locked(patch, by);
}

Result<protocol::SettingsApplied> Session::patch_locked(const protocol::RawJson& patch,
                                                        const std::string& by) {
  protocol::Settings patched = state_.settings;
  const Result<nlohmann::json> applied = protocol::apply_patch(patched, patch.value());
  if (!applied) return applied.error();
  if (const auto known = render::check_buffer_name(patched.view.buffer, "view.buffer"); !known) {
    return known.error();
  }
  protocol::RawJson effective(*applied);
  if (patched != state_.settings) {
    state_.settings = std::move(patched);
    if (state_.settings.reference.use != protocol::ReferenceUse::always) {
      before_reference_.reset();
      state_.keep_drawing = false;
    }
    changed();
    const protocol::SettingsChanged message{.rev = state_.rev, .patch = effective, .by = by};
    viewers_.send_others(
        by, protocol::make_notification<protocol::notifications::settings_changed>(message), {});
  }
  return protocol::SettingsApplied{.rev = state_.rev, .applied = std::move(effective)};
}

Result<protocol::StreamState> Session::configure_stream(const protocol::StreamConfigure& request,
                                                        const std::string& by, bool may_steer) {
  const std::lock_guard lock(mutex_);
  const std::uint32_t width =
      std::min(request.width.value_or(state_.width), options_.limits.max_width);
  const std::uint32_t height =
      std::min(request.height.value_or(state_.height), options_.limits.max_height);
  const bool resized = width != state_.width || height != state_.height;
  if (resized && !may_steer) {
    return error::make(protocol::ErrorCode::forbidden, width != state_.width ? "width" : "height",
                       "is shared by all viewers and cannot be changed with a read-only token");
  }
  if (resized && !viewers_.may_change(by)) return no_control(viewers_);
  // Fewer pixels are never refused: more are taken before anything is changed, fewer after it.
  const auto pixels_before = static_cast<std::uint64_t>(state_.width) * state_.height;
  const auto pixels = static_cast<std::uint64_t>(width) * height;
  if (pixels > pixels_before) {
    if (const auto fits = pixels_.resize(pixels); !fits) return fits.error();
  }
  ViewerStream stream;
  const bool only_size =
      !request.quality && !request.max_fps && !request.paused && !request.codec && !request.still;
  if (!by.empty() || !only_size) {
    const Result<ViewerStream> configured = viewers_.configure(by, request);
    if (!configured) {
      if (pixels > pixels_before) (void)pixels_.resize(pixels_before);
      return configured.error();
    }
    stream = *configured;
  }
  if (resized) {
    if (pixels < pixels_before) (void)pixels_.resize(pixels);
    state_.width = width;
    state_.height = height;
    changed();
    viewers_.announce_participants(info_locked());
  }
  return protocol::StreamState{.width = width,
                               .height = height,
                               .quality = static_cast<std::uint32_t>(stream.quality),
                               .max_fps = stream.max_fps,
                               .paused = stream.paused,
                               .codec = stream.codec,
                               .still = stream.still};
}

void Session::leave(const std::string& viewer) {
  viewers_.leave(viewer);
  forget(viewer);
}

Result<void> Session::move_to(const std::string& viewer, Session& there) {
  if (const auto moved = viewers_.move_to(viewer, there.viewers_); !moved) return moved;
  forget(viewer);
  return {};
}

void Session::forget(const std::string& viewer) {
  touch();
  {
    const std::lock_guard lock(mutex_);
    input_seqs_.erase(viewer);
  }
  drop_steps(protocol::error::not_found("session", "the viewer has left the session of the steps"),
             [&](const StepRequest& step) { return step.viewer == viewer; });
  changed_->notify();  // it may have waited for a picture
}

Result<void> Session::request_capture(CaptureRequest request) {
  const Result<void> accepted = accept_capture(std::move(request));
  if (accepted) {
    changed_->notify();
  } else if (measurements_) {
    measurements_->capture_failed();
  }
  return accepted;
}

Result<void> Session::accept_capture(CaptureRequest request) {
  const std::lock_guard lock(mutex_);
  if (const Result<void> there = require_scene(); !there) return there.error();
  if (const auto known = render::check_buffer_name(request.buffer, "buffer"); !known) {
    return known.error();
  }
  if (*open_captures_ >= options_.limits.max_captures) {
    return error::full("too many captures are pending",
                       std::to_string(options_.limits.max_captures));
  }
  ++*open_captures_;
  request.place = next_place();
  request.seat = std::shared_ptr<void>(nullptr, [open = open_captures_](void*) { --*open; });
  captures_.push_back(std::move(request));
  return {};
}

std::vector<CaptureRequest> Session::take_captures() {
  const std::lock_guard lock(mutex_);
  return std::exchange(captures_, {});
}

void Session::renew(DeviceMigration& renewal) {
  const RenderState before = render_state();
  const auto resources = renewal(before.resources);
  const auto environment = renewal(before.environment);
  if (resources == before.resources && environment == before.environment) return;
  const std::lock_guard lock(mutex_);
  if (state_.resources == before.resources) state_.resources = resources;
  if (state_.environment == before.environment) state_.environment = environment;
  for (DueStep& step : steps_) {
    if (step.state.resources == before.resources) step.state.resources = resources;
    if (step.state.environment == before.environment) step.state.environment = environment;
  }
  changed(false);
}

void Session::changed(bool new_revision) {
  ++state_.version;
  ++changes_;
  if (new_revision) ++state_.rev;
  state_.changed_at = Clock::now();
  changed_->notify();
}

Result<void> Session::require_scene() const {
  if (scene_) return {};
  return error::not_ready("no scene is loaded");
}

float Session::aspect() const {
  return static_cast<float>(state_.width) / static_cast<float>(state_.height);
}

}  // namespace heliograph::session
