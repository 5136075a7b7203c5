#include "session/rendering/session_view.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "session/event_log.hpp"

namespace heliograph::session {

using std::chrono::duration_cast;

namespace {

constexpr std::chrono::seconds retry_delay{1};
/// Longer than a session waits for its turn among many.
constexpr std::chrono::seconds sharing_window{1};
/// Frames of static views trace every sample: about how much longer they take than moving ones.
constexpr int refining_frame_factor = 2;
constexpr std::chrono::milliseconds frame_time_for_depth{20};

std::vector<protocol::BufferInfo> buffer_infos(const std::vector<render::BufferInfo>& buffers) {
  std::vector<protocol::BufferInfo> result;
  for (const auto& [name, description] : buffers) result.push_back({name, description});
  return result;
}

}  // namespace

SessionView::SessionView(render::Engine& engine, SessionOptions options, PixelShare pixels,
                         ViewServices services, std::shared_ptr<WakeEvent> wake)
    : engine_(engine),
      services_(services),
      wake_(std::move(wake)),
      session_(std::make_shared<Session>(std::move(options), wake_, std::move(pixels),
                                         &services.measurements)),
      broadcast_(session_, {.encoder = services.encoder,
                            .jpeg = services.jpeg,
                            .measurements = services.measurements,
                            .wake = wake_,
                            .tracer = engine.tracer(),
                            .read_pixels = [this] { return renderer_->read_pixels(); }}),
      readers_(*session_, services.capture_writer, services.measurements, services.wake) {}

SessionView::~SessionView() {
  if (preparing_.valid()) preparing_.wait();
}

void SessionView::prepare() {
  first_frame_due_ = true;
  make_renderer(state_of_new_renderer());
  publish_buffers();
}

bool SessionView::awake() const {
  return preparing_.valid() || renderer_ || wake_->is_notified() || needed();
}

/// Whether the renderer must stay: for viewers, for what is rendered without them, or for the
/// histories that the next step in lockstep builds on.
bool SessionView::needed() const {
  return first_frame_due_ || watched() || session_->renders_without_viewers();
}

/// Whether a viewer receives frames, or a capture or probe waits for one.
bool SessionView::watched() const {
  return !readers_.empty() || session_->viewers().has_active_viewer();
}

void SessionView::make_renderer(const RenderState& state) {
  renderer_ = std::make_unique<render::Renderer>(engine_, state.resources);
  renderer_->keep_buffers(false);
  apply(state.settings);
}

/// What a new renderer is made with; the rest is taken over with its first frame.
RenderState SessionView::state_of_new_renderer() {
  RenderState state = session_->render_state();
  if (!services_.migration.is_done(state.resources)) state.resources = nullptr;
  shown_scene_ = state.resources;
  needed_at_ = Clock::now();
  state_ = {};
  shown_parts_.reset();
  return state;
}

void SessionView::apply(const protocol::Settings& settings) {
  const auto accepted = renderer_->set_settings(settings);
  // The session has checked them, so there is no caller to answer.
  if (!accepted) throw std::logic_error("settings of a session: " + accepted.error().message);
}

void SessionView::publish_buffers() {
  session_->set_buffers(buffer_infos(renderer_->buffers()));
}

void SessionView::release_renderer() {
  if (preparing_.valid()) preparing_.wait();
  preparing_ = {};
  shown_scene_.reset();
  if (!renderer_) return;
  begun_.clear();
  renderer_.reset();
  newest_.reset();
  newest_stepped_ = false;
  broadcast_.reset();
  state_ = {};
  shown_parts_.reset();
  session_->viewers().discard_latest();
  log_info({.session = session_->name()}, "images released");
}

SessionView::Work SessionView::advance(bool may_draw) {
  if (Clock::now() < retry_at_ || is_preparing()) return Work::none;
  wake_->take();
  readers_.collect();
  session_->viewers().announce_due_frames();
  if (!renderer_ && !needed()) return Work::none;
  if (watched()) session_->mark_used();
  if (needed()) {
    needed_at_ = Clock::now();
  } else if (Clock::now() >= needed_at_ + services_.release_after) {
    release_renderer();
    return Work::none;
  }
  if (begin_migration()) return Work::small;
  if (!renderer_) {
    if (begin_making()) return Work::small;
    make_renderer(state_of_new_renderer());
  }
  const bool lockstep = session_->timeline().in_lockstep();
  keep_buffers(lockstep);
  if (lockstep) return advance_step(may_draw);
  newest_stepped_ = false;
  adopt_state();
  adopt_draw_scale();
  readers_.answer_probes(readable_frame(false));
  if (readers_.answer_captures(readable_frame(false))) return Work::small;
  if (next_view_state(view_inputs()) == ViewState::final) broadcast_.send_final();
  if (broadcast_.pump()) return Work::small;
  if (!frame_due()) return begin_freeing() ? Work::small : Work::none;
  // What a clip shows or hides has to be prepared. A frame comes of that before another moment.
  const bool switches_nodes = state_.animation.playing && clip_switches_nodes();
  if (switches_nodes && !prepared_moment_) adopt_moment();
  if (begin_preparing()) {
    if (switches_nodes && !prepared_moment_) prepared_moment_ = shown_moment_;
    return Work::small;
  }
  if (!may_draw) return Work::held_back;
  if (state_.animation.playing && !switches_nodes) adopt_moment();
  prepared_moment_.reset();
  begin_next_frame();
  return Work::drawing;
}

/// One requested frame, at full resolution whatever it takes; between steps the frame can be read
/// by what was requested before the next one.
SessionView::Work SessionView::advance_step(bool may_draw) {
  session_->timeline().fail_abandoned_steps();
  // Lockstep may have been left and entered again since.
  if (session_->timeline().reset_count() != state_.reset_count) newest_stepped_ = false;
  if (!newest_stepped_) readers_.fail_before_first_step();
  readers_.answer_probes(readable_frame(true));
  if (readers_.answer_captures(readable_frame(true))) return Work::small;
  const std::optional<Ticket> first_read = readers_.first_ticket();
  if (!may_draw && session_->timeline().step_due(first_read)) {
    return broadcast_.pump() ? Work::small : Work::held_back;
  }
  if (const std::optional<StepFrame> step = session_->timeline().begin_step(first_read)) {
    adopt(step->state);
    set_draw_scale(1.0f);
    begin_frame(step->seconds);
    if (in_flight()) finish_frame();
    newest_stepped_ = true;
    broadcast_.pump();
    session_->timeline().end_step(*step, newest_->frame.samples);
    return Work::drawing;
  }
  return broadcast_.pump() ? Work::small : Work::none;
}

std::optional<Clock::time_point> SessionView::next_due() const {
  if (preparing_.valid()) return std::nullopt;
  std::optional<Clock::time_point> due = session_->viewers().next_send();
  const auto consider = [&](Clock::time_point time) { due = due ? std::min(*due, time) : time; };
  if (retry_at_ > Clock::now()) consider(retry_at_);
  if (session_->timeline().in_lockstep()) return due;
  if (const auto transition = next_view_transition(view_inputs())) consider(*transition);
  if (renderer_) consider(std::max(needed_at_ + services_.release_after, retry_at_));
  return due;
}

void SessionView::recover() {
  // What the renderer had taken over of the state is not known: another one takes all of it.
  release_renderer();
  retry_at_ = Clock::now() + retry_delay;
  readers_.fail_all(protocol::error::internal());
  session_->timeline().fail_steps(protocol::error::internal());
}

void SessionView::abandon_captures() {
  readers_.drop_all();
  session_->timeline().fail_steps(protocol::error::not_ready("the server is shutting down"));
}

void SessionView::refuse_captures() {
  readers_.collect();
  const protocol::Error ended = protocol::error::not_found("session", "the session has ended");
  readers_.fail_all(ended);
  session_->timeline().fail_steps(ended);
}

/// Follows the times of moving frames slowly. Before there are any, refining frames tell.
void SessionView::measure_frame(ViewState state, Clock::duration taken) {
  const auto full = duration_cast<Clock::duration>(taken / time_share(draw_scale_));
  const bool known = full_frame_time_ > Clock::duration::zero();
  if (state == ViewState::moving) {
    moving_frame_at_ = Clock::now();
    full_frame_time_ = known ? (3 * full_frame_time_ + full) / 4 : full;
  } else if (!known) {
    full_frame_time_ = full / refining_frame_factor;
  }
}

bool SessionView::moves() const {
  return Clock::now() < moving_frame_at_ + sharing_window;
}

TurnKind SessionView::turn_kind() const {
  if (refines()) return TurnKind::refining;
  // What is being prepared is not touched.
  const bool starts = preparing_.valid() || !newest_ || !renderer_->has_begun();
  return starts ? TurnKind::starting : TurnKind::moving;
}

/// Whether its next frame only adds samples to a static image, and no capture waits for it. A view
/// whose newest state has waited for its turn is static by then, but not shown yet.
bool SessionView::refines() const {
  // What is being prepared is not touched.
  if (preparing_.valid() || !newest_ || newest_version_ != session_->version()) return false;
  return !session_->timeline().in_lockstep() && !readers_.has_captures() &&
         next_view_state(view_inputs()) == ViewState::refining;
}

bool SessionView::refines_reference() const {
  return refines() && readers_.empty() && lacks_reference_alone(state_.settings, newest_->frame);
}

/// A GPU has to copy it, which takes as long as a fast frame; and frames that come this often need
/// nothing between them.
bool SessionView::depth_pays() const {
  if (full_frame_time_ == Clock::duration::zero()) return true;
  return full_frame_time_ >= frame_time_for_depth ||
         engine_.device().type == protocol::DeviceType::cpu;
}

bool SessionView::is_full_size() const {
  return draw_scale_ == 1.0f;
}

/// A change and its reverse leave the image as it is, but the viewer that made them waits for a
/// frame of the newest revision, and the first viewer that wants depth for a frame with it.
bool SessionView::needs_frame() const {
  const bool lacks_depth = newest_ && !newest_->depth_read && session_->viewers().wants_depth();
  const bool outdated = newest_ && newest_->header.state_rev != state_.rev;
  return renderer_ &&
         (outdated || lacks_depth || state_.animation.playing || renderer_->needs_frame());
}

ViewInputs SessionView::view_inputs() const {
  return {.now = Clock::now(),
          .camera_moved_at = camera_moved_at_,
          .state_changed_at = state_.changed_at,
          .newer_state = session_->version() != state_.version,
          .animation_playing = state_.animation.playing,
          .lockstep = state_.lockstep.has_value(),
          .reduced_size = !is_full_size(),
          .needs_frame = needs_frame(),
          .has_frame = newest_ != nullptr,
          .converged = newest_ && newest_->frame.converged,
          .final_sent = broadcast_.final_sent()};
}

bool SessionView::frame_due() {
  const bool reference =
      state_.reference_started && state_.settings.reference.use == protocol::ReferenceUse::always;
  const bool first = first_frame_due_ && (state_.resources || session_->starts_empty());
  return should_draw(next_view_state(view_inputs()),
                     {.needs_frame = needs_frame(),
                      .requested = first || reference || !readers_.empty(),
                      .active_viewer = session_->viewers().has_active_viewer(),
                      .viewer_accepts = session_->viewers().can_accept_frame(),
                      .encoder_behind = broadcast_.behind()});
}

ReadableFrame SessionView::readable_frame(bool lockstep) {
  const bool shows_state =
      newest_version_ == state_.version || (!state_.animation.playing && !renderer_->needs_frame());
  return {.renderer = *renderer_,
          .state = state_,
          .newest = newest_.get(),
          .lockstep = lockstep,
          .shows_state = shows_state,
          .full_size = is_full_size(),
          .stepped = newest_stepped_,
          .began = frame_began_at_};
}

/// @throws what went wrong, once it has ended
bool SessionView::is_preparing() {
  if (!preparing_.valid()) return false;
  if (preparing_.wait_for(Clock::duration::zero()) != std::future_status::ready) return true;
  std::exchange(preparing_, {}).get();
  return false;
}

/// Frames of other sessions do not wait for a new session, or one that changes its size or passes.
bool SessionView::begin_preparing() {
  return renderer_->can_prepare() &&
         prepare_beside([renderer = renderer_.get()] { renderer->prepare(); });
}

/// Nor for its memory, which takes the driver of a GPU longer than a frame.
bool SessionView::begin_making() {
  if (engine_.device().type == protocol::DeviceType::cpu) return false;
  return prepare_beside([this, state = state_of_new_renderer()] { make_renderer(state); });
}

/// What another frame would free first.
bool SessionView::begin_freeing() {
  return renderer_->has_discarded() &&
         prepare_beside([renderer = renderer_.get()] { renderer->free_discarded(); });
}

/// A copy of a session may be on another device: its scene is uploaded there first.
bool SessionView::begin_migration() {
  if (session_->version() == state_.version || session_->is_on(services_.migration)) {
    return false;
  }
  return prepare_beside(
      [session = session_, &migration = services_.migration] { session->migrate(migration); });
}

/// False if there is no room for the task.
bool SessionView::prepare_beside(std::function<void()> prepare) {
  const auto task = std::make_shared<std::packaged_task<void()>>(std::move(prepare));
  std::future<void> preparing = task->get_future();
  const bool posted = services_.preparer.post([task, wake = wake_] {
    (*task)();
    wake->notify();
  });
  if (posted) preparing_ = std::move(preparing);
  return posted;
}

}  // namespace heliograph::session
