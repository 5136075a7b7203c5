#include "session/rendering/render_loop.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <exception>
#include <string>
#include <utility>

#include "protocol/json/jsonrpc.hpp"
#include "render/api/device_lost.hpp"
#include "session/event_log.hpp"

namespace heliograph::session {
namespace {

// One frame may wait for each that is being encoded: the renderer stays at most one ahead.
constexpr std::size_t queued_frames_per_thread = 1;
constexpr std::size_t most_encoding_threads = 8;
constexpr std::size_t most_preparing_threads = 4;
constexpr std::size_t max_queued_captures = 4;
constexpr std::size_t max_queued_preparations = 64;
constexpr std::chrono::milliseconds pause_without_memory{100};
constexpr std::chrono::milliseconds reference_pause{100};
constexpr std::chrono::seconds free_memory_interval{1};

/// Those of one of so many loops.
std::size_t processors(std::size_t loops) {
  return std::thread::hardware_concurrency() / loops;
}

/// On a GPU half of the processors encode; where they draw the frames, one thread is enough.
std::size_t encoding_threads(const render::DeviceInfo& device, std::size_t loops) {
  if (device.type == protocol::DeviceType::cpu) return 1;
  return std::clamp<std::size_t>(processors(loops) / 2, 1, most_encoding_threads);
}

/// The driver compiles on each of its own; frames need the other processors.
std::size_t preparing_threads(std::size_t loops) {
  return std::clamp<std::size_t>(processors(loops) / 4, 1, most_preparing_threads);
}

void log_shaders(const render::ShaderReport& report) {
  if (!report.error.empty()) {
    spdlog::error("shaders do not compile, the last good ones stay in use:\n{}", report.error);
  } else {
    spdlog::info(
        "shaders compiled, changed: {}",
        report.reloaded.empty() ? "none" : fmt::format("{}", fmt::join(report.reloaded, ", ")));
  }
}

}  // namespace

RenderLoop::RenderLoop(render::Engine& engine, Measurements& measurements,
                       const RenderLoopOptions& options)
    : engine_(engine),
      release_after_(options.release_after),
      measurements_(measurements),
      migration_(engine),
      free_memory_(render::free_memory(engine)),
      encoder_("encoder",
               queued_frames_per_thread * encoding_threads(engine.device(), options.loops),
               encoding_threads(engine.device(), options.loops)),
      capture_writer_("capture writer", max_queued_captures),
      preparer_("frame preparer", max_queued_preparations, preparing_threads(options.loops)),
      thread_([this] { run(); }) {
  engine_.on_shader_change([wake = wake_](const render::ShaderReport& report) {
    log_shaders(report);
    wake->notify();
  });
}

void RenderLoop::stop() {
  if (stopping_.exchange(true)) return;
  engine_.on_shader_change({});
  wake_->notify();
  thread_.join();
  encoder_.stop();
  capture_writer_.stop();
  preparer_.stop();
  for (const auto& view : views_) view->abandon_captures();
}

std::shared_ptr<Session> RenderLoop::open(SessionOptions options, PixelShare pixels) {
  auto view = std::make_shared<SessionView>(engine_, std::move(options), std::move(pixels),
                                            ViewServices{.wake = *wake_,
                                                         .release_after = release_after_,
                                                         .encoder = encoder_,
                                                         .jpeg = jpeg_,
                                                         .capture_writer = capture_writer_,
                                                         .preparer = preparer_,
                                                         .migration = migration_,
                                                         .measurements = measurements_},
                                            std::make_shared<WakeEvent>(wake_));
  std::shared_ptr<Session> session = view->session();
  if (session->name() == protocol::main_session) {
    try {
      view->prepare();
    } catch (const render::DeviceLost&) {
      view->release_renderer();  // it will be made on the next device
      report_device_loss();
    }
  }
  {
    const std::lock_guard lock(mutex_);
    views_.push_back(std::move(view));
  }
  wake_->notify();
  return session;
}

void RenderLoop::close(const Session& session) {
  {
    const std::lock_guard lock(mutex_);
    const auto closed = std::find_if(views_.begin(), views_.end(), [&](const auto& view) {
      return view->session().get() == &session;
    });
    if (closed == views_.end()) return;
    closed_.push_back(std::move(*closed));
    views_.erase(closed);
  }
  wake_->notify();
}

DeviceLoad RenderLoop::load() const {
  const std::lock_guard lock(mutex_);
  return {.ready = device_ready_,
          .busy = busy_.at(Clock::now()),
          .sessions = views_.size(),
          .free_memory = free_memory_};
}

DeviceTotals RenderLoop::device_totals() const {
  const std::lock_guard lock(mutex_);
  return device_totals_;
}

void RenderLoop::on_first_frame(std::function<void()> callback) {
  const std::lock_guard lock(mutex_);
  on_first_frame_ = std::move(callback);
}

void RenderLoop::run() {
  while (!stopping_) {
    try {
      advance_or_wait();
    } catch (const std::exception& failure) {
      // There is no memory for the loop itself. Other threads may free some.
      spdlog::error("the render loop: {}", failure.what());
      std::this_thread::sleep_for(pause_without_memory);
    }
  }
}

void RenderLoop::advance_or_wait() {
  const Views views = remove_closed();
  if (loss_reported_.exchange(false) && device_ready_) on_device_lost("outside of rendering");
  if (!device_ready_ && !recover_device(views)) return;
  if (advance_next(views) || finish_a_frame(true) || !device_ready_) return;
  auto due = next_due(views);
  if (held_back_until_) due = due ? std::min(*due, *held_back_until_) : *held_back_until_;
  occupied_ = std::ranges::any_of(views, [](const auto& view) { return view->plays(); });
  wake_->wait_until(due);
  occupied_ = true;
}

RenderLoop::Views RenderLoop::open_views() {
  const std::lock_guard lock(mutex_);
  return views_;
}

/// @returns those that are open: a view is gone, or among them when the device is recreated
RenderLoop::Views RenderLoop::remove_closed() {
  Views open;
  Views closed;
  {
    const std::lock_guard lock(mutex_);
    open = views_;
    closed.swap(closed_);
  }
  for (const auto& view : closed) {
    const auto frames =
        std::erase_if(in_flight_, [&](const InFlight& frame) { return frame.view == view; });
    for (auto i = frames; i > 0; --i) turns_.drop(Clock::now());
    view->refuse_captures();
    turns_.remove(view.get());
  }
  return open;
}

/// Does the short work of all sessions first, so that it does not wait for the frame of another
/// session; then the first session in order of turns that has a frame due renders it. While images
/// move, references that were not asked for wait.
bool RenderLoop::advance_next(const Views& views) {
  std::vector<DeviceTurns::Contender> ready;
  for (const auto& view : views) {
    if (view->awake() && !view->in_flight()) {
      ready.push_back({.view = view.get(), .kind = view->turn_kind()});
    }
  }
  turns_.sort(ready);
  held_back_until_.reset();
  others_wait_ = false;
  const auto moving = std::ranges::count_if(views, [](const auto& view) { return view->moves(); });
  if (moving > 0) moved_at_ = Clock::now();
  Views drawing;
  for (const DeviceTurns::Contender& contender : ready) {
    if (stopping_ || !device_ready_) return false;
    const auto& view =
        *std::ranges::find(views, contender.view, &std::shared_ptr<SessionView>::get);
    view->share_device(static_cast<std::size_t>(moving));
    const SessionView::Work work = advance(*view, false);
    if (work == SessionView::Work::small) return true;
    if (work != SessionView::Work::held_back) continue;
    if (moving > 0 && view->refines_reference()) {
      held_back_until_ = Clock::now() + reference_pause;
    } else {
      drawing.push_back(view);
    }
  }
  return std::ranges::any_of(drawing, [&](const auto& view) { return draw_in_turn(view); });
}

/// False if it has to wait for another session, or had nothing to draw after all.
bool RenderLoop::draw_in_turn(const std::shared_ptr<SessionView>& view) {
  if (stopping_ || !device_ready_) return false;
  const Clock::time_point start = Clock::now();
  const DeviceTurns::Contender contender{.view = view.get(), .kind = view->turn_kind()};
  if (waits_for_others_in_flight(contender.kind)) {
    others_wait_ = true;
    return false;
  }
  if (const auto until = turns_.hold_back(contender, start)) {
    others_wait_ = true;
    held_back_until_ = held_back_until_ ? std::min(*held_back_until_, *until) : *until;
    return false;
  }
  if (view->next_frame_moves()) moved_at_ = start;
  // Nothing may fail between the begin of a frame and its being listed.
  in_flight_.reserve(engine_.frames_at_once() + 1);
  const SessionView::Work work = advance(*view, true);
  // The device goes on with this frame while that of another view is shown.
  while (view->in_flight() && in_flight_.size() >= engine_.frames_at_once()) finish_a_frame(false);
  // A frame that waited for one before it did not use the device meanwhile.
  const Clock::time_point begun = std::max(start, device_free_);
  if (view->in_flight() && device_ready_) {
    in_flight_.push_back({view, turns_.begin(begun), contender.kind});
  } else if (work == SessionView::Work::drawing) {
    frame_finished(*view, turns_.begin(begun), contender.kind);
  }
  return work != SessionView::Work::none;
}

/// Beside images that move, those that are refined keep to one part of the device's time: their
/// frames are drawn alone. First frames begin one after the other.
bool RenderLoop::waits_for_others_in_flight(TurnKind kind) const {
  if (kind == TurnKind::moving || !images_move()) return false;
  return kind == TurnKind::refining
             ? !in_flight_.empty()
             : std::ranges::find(in_flight_, kind, &InFlight::kind) != in_flight_.end();
}

/// One that is done, or the oldest. False: no view has one in flight. `alone`: no other view has a
/// frame to draw.
bool RenderLoop::finish_a_frame(bool alone) {
  if (in_flight_.empty()) return false;
  auto next = std::ranges::find_if(
      in_flight_, [](const InFlight& frame) { return frame.view->frame_is_done(); });
  if (next == in_flight_.end()) next = in_flight_.begin();
  const InFlight finished = *next;
  in_flight_.erase(next);
  alone = alone && in_flight_.empty();
  SessionView& view = *finished.view;
  const auto finish = [&] {
    if (alone && !others_wait_ && view.can_begin_following())
      view.begin_following_frame(device_free_);
    view.finish_frame(device_free_);
  };
  if (attempt(view, finish)) {
    frame_finished(view, finished.frame, finished.kind);
    if (view.in_flight())
      in_flight_.push_back({finished.view, turns_.begin(device_free_), TurnKind::moving});
  } else {
    turns_.drop(Clock::now());
  }
  return true;
}

void RenderLoop::frame_finished(SessionView& view, const DeviceTurns::Frame& frame, TurnKind kind) {
  const Clock::time_point begun = std::max(frame.begun, device_free_);
  device_free_ = Clock::now();
  turns_.finish({.view = &view, .kind = kind}, frame, device_free_);
  {
    const std::lock_guard lock(mutex_);
    busy_.add(begun, device_free_);
    if (device_free_ >= free_memory_at_ + free_memory_interval) {
      free_memory_at_ = device_free_;
      free_memory_ = render::free_memory(engine_);
    }
    ++device_totals_.frames;
    device_totals_.seconds += std::chrono::duration<double>(device_free_ - begun).count();
  }
  if (!has_rendered_ && view.has_rendered()) report_first_frame();
}

SessionView::Work RenderLoop::advance(SessionView& view, bool may_draw) {
  auto work = SessionView::Work::none;
  attempt(view, [&] { work = view.advance(may_draw); });
  return work;
}

bool RenderLoop::attempt(SessionView& view, const std::function<void()>& work) {
  try {
    work();
    return true;
  } catch (const render::DeviceLost& failure) {
    on_device_lost("session " + view.session()->name() + ": " + failure.what());
  } catch (const std::exception& failure) {
    log_error({.session = view.session()->name()},
              std::string("rendering failed: ") + failure.what());
    view.recover();
  }
  return false;
}

void RenderLoop::report_device_loss() {
  loss_reported_ = true;
  wake_->notify();
}

void RenderLoop::on_new_device(std::function<void()> callback) {
  const std::lock_guard lock(mutex_);
  on_new_device_ = std::move(callback);
}

void RenderLoop::on_device_lost(const std::string& why) {
  device_ready_ = false;
  for (; !in_flight_.empty(); in_flight_.pop_back()) turns_.drop(Clock::now());
  ++device_losses_;
  const Clock::duration pause = retry_backoff_.after_loss(Clock::now());
  retry_at_ = Clock::now() + pause;
  const std::string when =
      pause == Clock::duration::zero()
          ? "immediately"
          : fmt::format("in {} s", std::chrono::duration_cast<std::chrono::seconds>(pause).count());
  spdlog::error("the device was lost; recovery {} ({})", when, why);
  notify_viewers(false, "the device was lost; recovery " + when);
}

/// Recreates the device once the retry delay is over. Sessions keep everything but their histories.
bool RenderLoop::recover_device(const Views& views) {
  if (Clock::now() < retry_at_) {
    wake_->wait_until(retry_at_);
    return false;
  }
  try {
    for (const auto& view : views) view->release_renderer();
    engine_.recreate();
    for (const auto& view : views) view->session()->migrate(migration_);
  } catch (const std::exception& failure) {
    on_device_lost(failure.what());
    return false;
  }
  std::function<void()> callback;
  {
    const std::lock_guard lock(mutex_);
    callback = on_new_device_;
  }
  if (callback) callback();
  retry_backoff_.recovered(Clock::now());
  device_ready_ = true;
  spdlog::info("the device is recovered, with {} sessions", views.size());
  notify_viewers(true, "the device is recovered");
  return true;
}

void RenderLoop::notify_viewers(bool ready, const std::string& message) {
  const std::string text = protocol::make_notification<protocol::notifications::device_changed>(
      {.ready = ready, .message = message});
  for (const auto& view : open_views()) {
    view->session()->viewers().send_all(text, "device.changed");
  }
}

std::optional<Clock::time_point> RenderLoop::next_due(const Views& views) const {
  std::optional<Clock::time_point> next;
  for (const auto& view : views) {
    const auto due = view->next_due();
    if (due) next = next ? std::min(*next, *due) : *due;
  }
  return next;
}

void RenderLoop::report_first_frame() {
  has_rendered_ = true;
  std::function<void()> callback;
  {
    const std::lock_guard lock(mutex_);
    callback.swap(on_first_frame_);
  }
  if (callback) callback();
}

}  // namespace heliograph::session
