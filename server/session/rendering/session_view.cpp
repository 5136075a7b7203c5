#include "session/rendering/session_view.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "scene/animation/pose.hpp"
#include "scene/camera.hpp"
#include "session/event_log.hpp"
#include "session/rendering/device_migration.hpp"

namespace heliograph::session {

using std::chrono::duration_cast;
using std::chrono::microseconds;
using std::chrono::milliseconds;

namespace {

/// Whole frames that take longer make a moving picture stutter.
constexpr milliseconds stuttering_frame{66};
/// Pixels of the smallest picture that is drawn smaller while moving.
constexpr std::uint32_t smallest_to_shrink = 640 * 360;
/// After the last change pictures are sent as they come for so long.
constexpr milliseconds rest_before_refining{150};
/// How long everything must rest before the final picture is sent.
constexpr milliseconds rest_before_final{300};
constexpr float longest_frame_seconds = 1.0f;
constexpr std::chrono::seconds rest_after_failure{1};

std::uint32_t microseconds_of(Clock::duration duration) {
  return static_cast<std::uint32_t>(duration_cast<microseconds>(duration).count());
}

std::vector<protocol::BufferInfo> buffer_infos(const std::vector<render::BufferInfo>& buffers) {
  std::vector<protocol::BufferInfo> result;
  for (const auto& [name, description] : buffers) result.push_back({name, description});
  return result;
}

std::vector<protocol::PassTiming> pass_timings_of(const std::vector<render::PassTime>& passes) {
  std::vector<protocol::PassTiming> result;
  for (const render::PassTime& pass : passes) {
    result.push_back({.name = pass.name, .kind = pass.kind, .ms = pass.milliseconds});
  }
  return result;
}

SceneEdits::Lights file_lights(const scene::Scene& scene) {
  SceneEdits::Lights lights;
  for (const scene::Light& light : scene.lights) lights.push_back(light.device);
  return lights;
}

}  // namespace

SessionView::SessionView(render::Engine& engine, SessionOptions options, PixelShare pixels,
                         ViewServices services, std::shared_ptr<WakeEvent> wakeup)
    : engine_(engine),
      services_(services),
      wakeup_(std::move(wakeup)),
      session_(std::make_shared<Session>(std::move(options), wakeup_, std::move(pixels),
                                         &services.measurements)),
      broadcast_(session_, {.encoder = services.encoder,
                            .jpeg = services.jpeg,
                            .measurements = services.measurements,
                            .wakeup = wakeup_,
                            .tracer = engine.tracer()}) {}

SessionView::~SessionView() = default;

void SessionView::prepare() {
  draws_unasked_ = true;
  make_renderer();
  tell_buffers();
}

bool SessionView::awake() const {
  return renderer_ || wakeup_->is_notified() || needed();
}

/// Whether the renderer must stay: for somebody, for what is to be drawn unwatched, or for the
/// histories that the next step builds on.
bool SessionView::needed() const {
  return draws_unasked_ || watched() || session_->renders_without_viewers();
}

/// Whether somebody is there for pictures, or waits for one.
bool SessionView::watched() const {
  return !captures_.empty() || !probes_.empty() || session_->viewers().has_active_viewer();
}

void SessionView::make_renderer() {
  renderer_ = std::make_unique<render::Renderer>(engine_);
  needed_at_ = Clock::now();
  state_ = {};
  apply(session_->render_state().settings);
}

void SessionView::apply(const protocol::Settings& settings) {
  const auto accepted = renderer_->set_settings(settings);
  // A session takes in no others, so nobody would ever hear of it.
  if (!accepted) throw std::logic_error("settings of a session: " + accepted.error().message);
}

void SessionView::tell_buffers() {
  session_->set_buffers(buffer_infos(renderer_->buffers()));
}

void SessionView::release_renderer() {
  if (!renderer_) return;
  renderer_.reset();
  newest_.reset();
  stepped_ = false;
  broadcast_.forget();
  state_ = {};
  session_->viewers().discard_latest();
  log_info({.session = session_->name()}, "images released");
}

SessionView::Work SessionView::advance(bool may_draw) {
  if (Clock::now() < resting_until_) return Work::none;
  wakeup_->take();
  collect_captures();
  session_->viewers().announce_due_frames();
  if (!renderer_) {
    if (!needed()) return Work::none;
    make_renderer();
  }
  if (watched()) session_->touch();
  if (needed()) {
    needed_at_ = Clock::now();
  } else if (Clock::now() >= needed_at_ + services_.release_after) {
    release_renderer();
    return Work::none;
  }
  if (session_->in_lockstep()) return advance_step(may_draw);
  stepped_ = false;
  adopt_state();
  adopt_size();
  settle_probes();
  if (settle_captures()) return Work::small;
  if (final_due()) broadcast_.finish();
  if (broadcast_.pump()) return Work::small;
  if (!frame_wanted()) return Work::none;
  if (!may_draw) return Work::held_back;
  render_frame();
  return Work::drawing;
}

std::optional<Clock::time_point> SessionView::next_due() const {
  std::optional<Clock::time_point> due = session_->viewers().next_send();
  if (session_->in_lockstep()) return due;
  const auto also = [&](Clock::time_point time) { due = due ? std::min(*due, time) : time; };
  if (newest_ && newest_->frame.converged && !broadcast_.finished() && !state_.animation.playing) {
    const Clock::time_point rested = state_.changed_at + rest_before_final;
    if (rested > Clock::now()) also(rested);
  }
  const Clock::time_point rests = moved_at_ + rest_before_final;
  if (!draws_whole() && rests > Clock::now()) also(rests);
  if (resting_until_ > Clock::now()) also(resting_until_);
  if (renderer_) also(std::max(needed_at_ + services_.release_after, resting_until_));
  return due;
}

void SessionView::recover() {
  // What of the state it had taken over nobody knows: another one takes all of it.
  release_renderer();
  resting_until_ = Clock::now() + rest_after_failure;
  for (PendingCapture& capture : captures_) capture.request.done(protocol::error::internal());
  captures_.clear();
  for (const PendingProbe& pending : probes_) pending.probe.fail(protocol::error::internal());
  probes_.clear();
  session_->fail_steps(protocol::error::internal());
}

void SessionView::adopt_state() {
  if (session_->version() != state_.version) adopt(session_->render_state());
}

void SessionView::adopt(RenderState next) {
  const RenderState before = std::exchange(state_, std::move(next));
  const auto lost = [&](const auto& object) { return object && !engine_.owns(*object); };
  if (lost(state_.resources) || lost(state_.environment)) {
    // It was loaded just before the device was lost.
    DeviceMigration renewal(engine_);
    session_->renew(renewal);
    state_ = session_->render_state();
  }
  if (state_.resources != before.resources) renderer_->set_scene(state_.resources);
  adopt_edits(before);
  if (state_.reset_count != before.reset_count) {
    renderer_->start_anew();
    cut_ = true;
  }
  const bool same_scene = state_.resources == before.resources;
  const bool resized = state_.width != before.width || state_.height != before.height;
  if (resized) whole_frame_ = {};
  const bool jumped = state_.cuts != before.cuts;
  if (jumped) renderer_->cut();
  cut_ |= resized || !same_scene || jumped;
  if (same_scene && !scene::same_view(state_.camera, before.camera)) moved_at_ = Clock::now();
  adopt_pose();
  apply(state_.settings);
  tell_buffers();
}

/// What the session changed in the scene; a scene that is new to the renderer has no changes yet.
void SessionView::adopt_edits(const RenderState& before) {
  const bool same_scene = state_.resources == before.resources;
  if (state_.lights != (same_scene ? before.lights : nullptr)) {
    renderer_->set_lights(state_.lights ? *state_.lights : file_lights(*state_.scene));
  }
  if (state_.materials != (same_scene ? before.materials : nullptr)) {
    renderer_->set_materials(state_.materials ? *state_.materials : state_.scene->materials);
  }
  if (state_.environment != (same_scene ? before.environment : nullptr)) {
    renderer_->set_environment(state_.environment);
    cut_ = true;
  }
}

/// Where the clip stands now, and the camera with it.
void SessionView::adopt_pose() {
  const double seconds = state_.animation.at(state_.now());
  if (const auto posed = renderer_->set_pose(state_.animation.clip, seconds); !posed) {
    log_error({.session = session_->name()}, posed.error().message);
  }
  const scene::Clip* const clip =
      state_.camera_follows ? scene::find_clip(*state_.scene, state_.animation.clip) : nullptr;
  if (!clip) {
    renderer_->set_camera(state_.camera);
    return;
  }
  scene::Pose pose = scene::rest_pose(*state_.scene);
  scene::evaluate(*state_.scene, *clip, seconds, pose);
  renderer_->set_camera(scene::camera_at(*state_.scene, state_.camera, pose));
}

bool SessionView::moving() const {
  if (state_.animation.playing) return true;
  return Clock::now() < moved_at_ + rest_before_final;
}

/// Nothing changes, and what is drawn is what stays. A change that came while a slow picture was
/// drawn is still to be taken over.
bool SessionView::resting() const {
  return session_->version() == state_.version && !state_.animation.playing && draws_whole() &&
         Clock::now() >= state_.changed_at + rest_before_refining;
}

/// Small while the camera moves and whole frames would stutter, whole again once it rests and for
/// captures.
void SessionView::adopt_size() {
  const bool shrink = moving() && captures_.empty() && whole_frame_ > stuttering_frame &&
                      state_.width * state_.height > smallest_to_shrink;
  const float scale = shrink ? state_.settings.motion.scale : 1.0f;
  const auto scaled = [&](std::uint32_t side) {
    return std::max(1u, static_cast<std::uint32_t>(static_cast<float>(side) * scale + 0.5f));
  };
  drawn_width_ = scaled(state_.width);
  drawn_height_ = scaled(state_.height);
  renderer_->set_size(drawn_width_, drawn_height_);
}

bool SessionView::draws_whole() const {
  return drawn_width_ == state_.width && drawn_height_ == state_.height;
}

bool SessionView::frame_wanted() {
  // A change and its opposite make no other picture, but who made them waits for one of that state.
  const bool shown = !newest_ || newest_->header.state_rev == state_.rev;
  if (shown && !renderer_->needs_frame() && !state_.animation.playing) return false;
  const bool first = draws_unasked_ && state_.resources;
  const bool reference =
      state_.keep_drawing && state_.settings.reference.use == protocol::ReferenceUse::always;
  if (first || reference || !captures_.empty() || !probes_.empty()) return true;
  // A resting picture gets better at full speed, since few of its samples are sent.
  if (resting()) return session_->viewers().has_active_viewer();
  return !broadcast_.behind() && session_->viewers().can_accept_frame();
}

bool SessionView::final_due() const {
  return newest_ && draws_whole() && newest_->frame.converged && !broadcast_.finished() &&
         !state_.animation.playing && !renderer_->needs_frame() &&
         Clock::now() >= state_.changed_at + rest_before_final;
}

/// Histories are counted in seconds. After a rest the time since the last picture means nothing.
void SessionView::render_frame() {
  const std::chrono::duration<float> since = Clock::now() - last_frame_;
  stepped_ = false;
  render_frame(std::min(since.count(), longest_frame_seconds));
}

void SessionView::render_frame(double seconds) {
  const Clock::time_point start = Clock::now();
  session_->touch();
  if (state_.animation.playing) adopt_pose();
  renderer_->set_frame_seconds(static_cast<float>(seconds));
  last_frame_ = start;
  render::Frame frame = renderer_->render();
  const Clock::time_point end = Clock::now();
  if (draws_whole()) whole_frame_ = end - start;
  services_.measurements.rendered(std::chrono::duration<double>(end - start).count(),
                                  pass_timings_of(frame.passes));
  newest_ = describe(std::move(frame), start, end);
  draws_unasked_ = false;
  newest_version_ = state_.version;
  session_->report_frame(newest_version_, newest_->frame.samples, newest_->frame.converged);
  broadcast_.rendered(newest_, !state_.lockstep && resting());
}

std::shared_ptr<RenderedFrame> SessionView::describe(render::Frame frame, Clock::time_point start,
                                                     Clock::time_point end) {
  recent_frames_.push_back(end);
  while (recent_frames_.front() < end - std::chrono::seconds(1)) recent_frames_.pop_front();

  auto picture = std::make_shared<RenderedFrame>();
  protocol::FrameHeader& header = picture->header;
  if (std::exchange(cut_, false)) ++cuts_;
  header.render_id = ++render_count_;
  header.state_rev = state_.rev;
  header.full_width = static_cast<std::uint16_t>(state_.width);
  header.full_height = static_cast<std::uint16_t>(state_.height);
  header.render_start_us =
      static_cast<std::uint64_t>(duration_cast<microseconds>(start.time_since_epoch()).count());
  header.render_us = microseconds_of(end - start);
  header.sample_count = frame.samples;
  picture->frame = std::move(frame);
  picture->inputs = state_.inputs;
  picture->cuts = cuts_;
  picture->fps = static_cast<double>(recent_frames_.size());
  return picture;
}

}  // namespace heliograph::session
