#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "session/session_view.hpp"

namespace heliograph::session {

/// The one thread that draws for all sessions of a device, each in turn, and the threads that
/// encode beside it. It sleeps while nobody wants anything.
class RenderLoop {
 public:
  explicit RenderLoop(render::Engine& engine);
  ~RenderLoop() { stop(); }
  RenderLoop(const RenderLoop&) = delete;
  RenderLoop& operator=(const RenderLoop&) = delete;

  /// Opens a session; it is drawn from now on. @throws as SessionView does
  std::shared_ptr<Session> open(SessionOptions options, PixelShare pixels);
  /// The session is drawn no more; captures that wait are refused.
  void close(const Session& session);

  /// Called once, on the render thread, when the first picture is there.
  void on_first_frame(std::function<void()> callback);
  bool has_rendered() const { return has_rendered_; }
  /// Ends the threads and everything that waits for them. No callback comes afterwards.
  void stop();
  RenderTotals totals() const { return measurements_.totals(); }

 private:
  using Views = std::vector<std::shared_ptr<SessionView>>;

  void run();
  void dismiss_closed();
  bool advance_all(const Views& views);
  bool advance(SessionView& view);
  std::optional<Clock::time_point> next_due(const Views& views) const;
  void report_first_frame();

  render::Engine& engine_;
  const std::shared_ptr<Wakeup> wakeup_ = std::make_shared<Wakeup>();
  Measurements measurements_;
  std::mutex mutex_;  // guards views_, closed_ and on_first_frame_; never held while drawing
  Views views_;
  Views closed_;  // end on the render thread, which may be at work on them
  std::function<void()> on_first_frame_;
  std::atomic<bool> has_rendered_ = false;
  std::atomic<bool> stopping_ = false;
  stream::JpegEncoder jpeg_;
  Worker encoder_;
  Worker capture_writer_;
  std::thread thread_;
};

}  // namespace heliograph::session
