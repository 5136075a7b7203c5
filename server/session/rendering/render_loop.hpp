#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "session/rendering/fair_share.hpp"
#include "session/rendering/retry_backoff.hpp"
#include "session/rendering/session_view.hpp"

namespace heliograph::session {

/// The one thread that draws for all sessions of a device, in fair shares of its time, and the
/// threads that encode beside it. It sleeps while nobody wants anything.
class RenderLoop {
 public:
  /// Sessions that nobody has watched for `release_after` give back the memory of their pictures.
  RenderLoop(render::Engine& engine, Clock::duration release_after);
  ~RenderLoop() { stop(); }
  RenderLoop(const RenderLoop&) = delete;
  RenderLoop& operator=(const RenderLoop&) = delete;

  /// Opens a session; it is drawn from now on. The first one is made ready at once and draws its
  /// first picture unasked: it shows that everything works.
  /// @throws std::invalid_argument when the renderer refuses the settings
  std::shared_ptr<Session> open(SessionOptions options, PixelShare pixels);
  /// The session is drawn no more; captures that wait are refused.
  void close(const Session& session);

  /// Called once, on the render thread, when the first picture is there.
  void on_first_frame(std::function<void()> callback);
  bool has_rendered() const { return has_rendered_; }
  /// Another thread's work met render::DeviceLost.
  void report_device_loss();
  /// False from the loss of the device until there is another one.
  bool device_ready() const { return device_ready_; }
  std::uint64_t device_losses() const { return device_losses_; }
  /// Called on the render thread whenever there is another device.
  void on_new_device(std::function<void()> callback);
  /// Ends the threads and everything that waits for them. No callback comes afterwards.
  void stop();
  RenderTotals totals() const { return measurements_.totals(); }

 private:
  using Views = std::vector<std::shared_ptr<SessionView>>;

  void run();
  Views open_views();
  void dismiss_closed();
  bool advance_next(const Views& views);
  bool draw_in_turn(SessionView& view);
  SessionView::Work advance(SessionView& view, bool may_draw);
  std::optional<Clock::time_point> next_due(const Views& views) const;
  void report_first_frame();
  void on_device_lost(const std::string& why);
  bool recover_device(const Views& views);
  void tell_viewers(bool ready, const std::string& message);

  render::Engine& engine_;
  const Clock::duration release_after_;
  FairShare share_;  // of the render thread
  const std::shared_ptr<WakeEvent> wakeup_ = std::make_shared<WakeEvent>();
  Measurements measurements_;
  std::mutex mutex_;  // guards views_, closed_ and the callbacks; never held while drawing
  Views views_;
  Views closed_;  // end on the render thread, which may be at work on them
  std::function<void()> on_first_frame_;
  std::function<void()> on_new_device_;
  std::atomic<bool> has_rendered_ = false;
  std::atomic<bool> device_ready_ = true;
  std::atomic<bool> loss_reported_ = false;
  std::atomic<std::uint64_t> device_losses_ = 0;
  RetryBackoff retry_backoff_;  // of the render thread, like the next two
  Clock::time_point retry_at_;
  std::optional<Clock::time_point> held_back_until_;
  std::atomic<bool> stopping_ = false;
  stream::JpegEncoder jpeg_;
  Worker encoder_;
  Worker capture_writer_;
  std::thread thread_;
};

}  // namespace heliograph::session
