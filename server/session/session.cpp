#include "session/session.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "protocol/settings/settings_json.hpp"
#include "session/devices/device_migration.hpp"

namespace heliograph::session {

using protocol::Result;
namespace error = protocol::error;

protocol::Error no_control(const ViewerSet& viewers) {
  if (viewers.control_is_free()) {
    return error::make(protocol::ErrorCode::forbidden, "control",
                       "no viewer has control of this session; take control first",
                       "session.control with the action take");
  }
  return error::make(protocol::ErrorCode::forbidden, "control",
                     "another viewer has control of this session", "session.control");
}

Session::Session(SessionOptions options, std::shared_ptr<WakeEvent> wake, PixelShare pixels,
                 Measurements* measurements)
    : core_(std::move(options), std::move(wake), measurements), pixels_(std::move(pixels)) {}

std::uint32_t Session::rev() const {
  const std::lock_guard lock(core_.mutex);
  return core_.rev;
}

std::uint64_t Session::version() const {
  const std::lock_guard lock(core_.mutex);
  return core_.version;
}

RenderState Session::render_state() const {
  const std::lock_guard lock(core_.mutex);
  return core_.snapshot();
}

protocol::SessionInfo Session::info(const std::string& viewer) const {
  const std::lock_guard lock(core_.mutex);
  protocol::SessionInfo info = info_locked();
  info.viewers = core_.viewers.participants(viewer);
  return info;
}

protocol::SessionInfo Session::info_locked() const {
  protocol::SessionInfo info{.name = name(),
                             .scene = std::nullopt,
                             .width = core_.width,
                             .height = core_.height,
                             .viewers = {},
                             .control = core_.viewers.control_mode(),
                             .rev = core_.rev,
                             .idle_seconds = std::chrono::duration<double>(idle()).count(),
                             .device = static_cast<std::uint32_t>(device()),
                             .follows = std::nullopt};
  if (!follows().empty()) info.follows = follows();
  if (core_.scene) info.scene = core_.scene_info.name;
  return info;
}

void Session::announce() {
  const std::lock_guard lock(core_.mutex);
  core_.viewers.announce_participants(info_locked());
}

bool Session::renders_without_viewers() const {
  const std::lock_guard lock(core_.mutex);
  return core_.timeline.in_lockstep() || core_.reference.started();
}

bool Session::is_pristine(const std::string& viewer) const {
  return !modified_ && core_.viewers.control_mode() == protocol::ControlMode::shared &&
         !core_.viewers.has_other_participant(viewer);
}

Clock::duration Session::idle() const {
  if (!core_.viewers.empty()) return {};
  return Clock::now() - used_at_.load();
}

void Session::end() {
  ended_ = true;
  const std::lock_guard lock(core_.mutex);
  pixels_.release();
}

void Session::copy_from(const Session& other) {
  const SessionCore& from = other.core_;
  const std::scoped_lock lock(core_.mutex, from.mutex);
  core_.settings = from.settings;
  core_.scene = from.scene;
  core_.resources = from.resources;
  core_.scene_info = from.scene_info;
  core_.edits = from.edits;
  core_.nodes = from.nodes;
  core_.section = from.section;
  core_.environment = from.environment;
  core_.environment_name = from.environment_name;
  core_.camera.copy_from(from.camera);
  core_.bookmarks = from.bookmarks;
  core_.measured = from.measured;
  core_.annotations = from.annotations;
  core_.timeline.copy_from(from.timeline);
  core_.reference.copy_from(from.reference);
  buffers_ = other.buffers_;
  core_.changed();
  core_.scene_rev = core_.rev;
}

void Session::follow(const std::shared_ptr<Session>& follower, Session& leader) {
  follower->set_buffers(leader.buffers());
  const std::lock_guard lock(leader.core_.mutex);
  follower->core_.follow(leader.core_);
  {
    const std::lock_guard own_lock(follower->core_.mutex);
    follower->core_.camera.copy_from(leader.core_.camera);
  }
  auto& followers = leader.core_.followers;
  std::erase_if(followers, [](const auto& weak) { return weak.expired(); });
  followers.emplace_back(std::shared_ptr<SessionCore>(follower, &follower->core_));
}

void Session::follow_camera(const std::shared_ptr<Session>& follower, Session& source,
                            const std::string& by) {
  const std::shared_ptr<SessionCore> core(follower, &follower->core_);
  const std::uint64_t link = core->renew_camera_link();
  std::unique_lock lock(source.core_.mutex);
  source.core_.camera_followers.push_back({.session = core, .link = link});
  source.core_.pass_camera_on(std::move(lock), by);
}

void Session::unfollow_camera(Session& follower, Session& source) {
  {
    const std::lock_guard lock(source.core_.mutex);
    std::erase_if(source.core_.camera_followers, [&](const CameraFollower& entry) {
      const auto core = entry.session.lock();
      return !core || core.get() == &follower.core_;
    });
  }
  (void)follower.core_.renew_camera_link();
}

void Session::set_buffers(std::vector<protocol::BufferInfo> buffers) {
  const std::lock_guard lock(core_.mutex);
  buffers_ = std::move(buffers);
}

std::vector<protocol::BufferInfo> Session::buffers() const {
  const std::lock_guard lock(core_.mutex);
  return buffers_;
}

protocol::SettingsState Session::settings() const {
  const std::lock_guard lock(core_.mutex);
  return {.rev = core_.rev, .settings = protocol::RawJson(protocol::to_json(core_.settings))};
}

Result<protocol::SettingsApplied> Session::patch_settings(const protocol::RawJson& patch,
                                                          const std::string& by) {
  const std::lock_guard lock(core_.mutex);
  return core_.patch_settings(patch, by);
}

Result<protocol::StreamState> Session::configure_stream(const protocol::StreamConfigure& request,
                                                        const std::string& by, bool read_only) {
  const std::lock_guard lock(core_.mutex);
  const SessionLimits& limits = core_.options.limits;
  const FrameSize asked{std::min(request.width.value_or(core_.width), limits.max_width),
                        std::min(request.height.value_or(core_.height), limits.max_height)};
  const bool sized = request.width || request.height;
  const bool other = asked != FrameSize{core_.width, core_.height};
  const bool may_ask = may_resize(by, read_only);
  if (other && read_only && !may_ask) {
    return error::make(protocol::ErrorCode::forbidden,
                       asked.width != core_.width ? "width" : "height",
                       "is shared by all viewers and cannot be changed with a read-only token");
  }
  if (other && !may_ask) return no_control(core_.viewers);
  const bool wants = sized && !by.empty() && may_ask;
  const FrameSize size = wants ? size_for(core_.viewers.wanted_sizes(by), asked) : asked;
  // More pixels are reserved before anything changes; fewer are released after it.
  const auto pixels_before = static_cast<std::uint64_t>(core_.width) * core_.height;
  const auto pixels = static_cast<std::uint64_t>(size.width) * size.height;
  if (pixels > pixels_before) {
    if (const auto fits = pixels_.resize(pixels); !fits) return fits.error();
  }
  const Result<ViewerStream> stream = configure_viewer(request, by);
  if (!stream) {
    if (pixels > pixels_before) (void)pixels_.resize(pixels_before);
    return stream.error();
  }
  if (wants) core_.viewers.want_size(by, asked);
  if (pixels < pixels_before) (void)pixels_.resize(pixels);
  resize(size);
  return protocol::StreamState{.width = size.width,
                               .height = size.height,
                               .quality = static_cast<std::uint32_t>(stream->quality),
                               .max_fps = stream->max_fps,
                               .paused = stream->paused,
                               .codec = stream->codec,
                               .still = stream->still,
                               .depth = stream->depth};
}

/// The size of a view of one's own is one's own.
bool Session::may_resize(const std::string& by, bool read_only) const {
  return !follows().empty() || (!read_only && core_.viewers.may_change(by));
}

FrameSize Session::size_for(std::vector<FrameSize> wanted, std::optional<FrameSize> more) const {
  if (more) wanted.push_back(*more);
  const SessionLimits& limits = core_.options.limits;
  return common_size(wanted, {limits.max_width, limits.max_height});
}

/// A caller without a stream can change the size only.
Result<ViewerStream> Session::configure_viewer(const protocol::StreamConfigure& request,
                                               const std::string& by) {
  const bool only_size = !request.quality && !request.max_fps && !request.paused &&
                         !request.codec && !request.still && !request.depth;
  if (by.empty() && only_size) return ViewerStream();
  return core_.viewers.configure(by, request);
}

void Session::resize(FrameSize size) {
  if (size == FrameSize{core_.width, core_.height}) return;
  core_.width = size.width;
  core_.height = size.height;
  core_.changed();
  core_.viewers.announce_participants(info_locked());
}

void Session::leave(const std::string& viewer) {
  core_.viewers.leave(viewer);
  discard_requests_of(viewer);
  restore_size();
}

/// After a viewer has left, to what suits the others; the last one's size stays.
void Session::restore_size() {
  const std::lock_guard lock(core_.mutex);
  const std::vector<FrameSize> wanted = core_.viewers.wanted_sizes();
  if (wanted.empty()) return;
  const FrameSize size = size_for(wanted);
  if (pixels_.resize(static_cast<std::uint64_t>(size.width) * size.height)) resize(size);
}

Result<void> Session::move_to(const std::string& viewer, Session& other) {
  if (const auto moved = core_.viewers.move_to(viewer, other.core_.viewers); !moved) return moved;
  discard_requests_of(viewer);
  restore_size();
  return {};
}

void Session::discard_requests_of(const std::string& viewer) {
  mark_used();
  {
    const std::lock_guard lock(core_.mutex);
    core_.camera.remove_viewer(viewer);
    if (core_.first_view) core_.first_view->camera.remove_viewer(viewer);
  }
  timeline_.fail_steps_of(
      viewer, error::not_found("session", "the viewer has left the session of the steps"));
  core_.wake->notify();  // the render thread drops its captures
}

bool Session::is_on(const DeviceMigration& device) const {
  const std::lock_guard lock(core_.mutex);
  const auto& shown = core_.shows_first_view() ? core_.first_view->resources : core_.resources;
  return device.is_done(shown) && device.is_done(core_.environment);
}

void Session::migrate(DeviceMigration& migration) {
  const RenderState before = render_state();
  const auto resources = migration(before.resources);
  const auto environment = migration(before.environment);
  if (resources == before.resources && environment == before.environment) return;
  const auto update = [&](auto& state) {
    if (state.resources == before.resources) state.resources = resources;
    if (state.environment == before.environment) state.environment = environment;
  };
  const std::lock_guard lock(core_.mutex);
  update(core_);
  if (core_.first_view && core_.first_view->resources == before.resources) {
    core_.first_view->resources = resources;
  }
  core_.timeline.update_pending(update);
  core_.changed(false);
}

}  // namespace heliograph::session
