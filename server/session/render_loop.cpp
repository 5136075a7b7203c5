#include "session/render_loop.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <exception>
#include <utility>

namespace heliograph::session {
namespace {

// One picture may wait while another is being encoded: the renderer stays at most one ahead.
constexpr std::size_t waiting_pictures = 1;
constexpr std::size_t waiting_captures = 4;

}  // namespace

RenderLoop::RenderLoop(render::Engine& engine)
    : engine_(engine),
      encoder_("encoder", waiting_pictures),
      capture_writer_("capture writer", waiting_captures),
      thread_([this] { run(); }) {}

void RenderLoop::stop() {
  if (stopping_.exchange(true)) return;
  wakeup_->notify();
  thread_.join();
  encoder_.stop();
  capture_writer_.stop();
  for (const auto& view : views_) view->abandon_captures();
}

std::shared_ptr<Session> RenderLoop::open(SessionOptions options, PixelShare pixels) {
  auto view = std::make_shared<SessionView>(engine_, std::move(options), std::move(pixels),
                                            ViewServices{.wakeup = *wakeup_,
                                                         .encoder = encoder_,
                                                         .jpeg = jpeg_,
                                                         .capture_writer = capture_writer_,
                                                         .measurements = measurements_},
                                            std::make_shared<Wakeup>(wakeup_));
  std::shared_ptr<Session> session = view->session();
  {
    const std::lock_guard lock(mutex_);
    views_.push_back(std::move(view));
  }
  wakeup_->notify();
  return session;
}

void RenderLoop::close(const Session& session) {
  {
    const std::lock_guard lock(mutex_);
    const auto found = std::find_if(views_.begin(), views_.end(), [&](const auto& view) {
      return view->session().get() == &session;
    });
    if (found == views_.end()) return;
    closed_.push_back(std::move(*found));
    views_.erase(found);
  }
  wakeup_->notify();
}

void RenderLoop::on_first_frame(std::function<void()> callback) {
  const std::lock_guard lock(mutex_);
  on_first_frame_ = std::move(callback);
}

void RenderLoop::run() {
  while (!stopping_) {
    dismiss_closed();
    Views views;
    {
      const std::lock_guard lock(mutex_);
      views = views_;
    }
    if (advance_all(views)) continue;
    wakeup_->wait_until(next_due(views));
  }
}

void RenderLoop::dismiss_closed() {
  Views closed;
  {
    const std::lock_guard lock(mutex_);
    closed.swap(closed_);
  }
  for (const auto& view : closed) view->refuse_captures();
}

bool RenderLoop::advance_all(const Views& views) {
  bool worked = false;
  for (const auto& view : views) {
    if (stopping_) return false;
    worked |= advance(*view);
    if (!has_rendered_ && view->has_rendered()) report_first_frame();
  }
  return worked;
}

bool RenderLoop::advance(SessionView& view) {
  try {
    return view.advance();
  } catch (const std::exception& failure) {
    spdlog::error("session {}: rendering failed: {}", view.session()->name(), failure.what());
    view.recover();
    return false;
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
