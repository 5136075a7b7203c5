#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "render/api/devices.hpp"
#include "session/devices/device_migration.hpp"
#include "session/devices/placement.hpp"
#include "session/rendering/device_turns.hpp"
#include "session/rendering/retry_backoff.hpp"
#include "session/rendering/session_view.hpp"

namespace heliograph::session {

struct RenderLoopOptions {
  Clock::duration release_after{};  // sessions without viewers for so long release their renderer
  std::size_t loops = 1;            // that share the processors, of a device each
};

/// What a device has done since the start.
struct DeviceTotals {
  std::uint64_t frames = 0;
  double seconds = 0.0;  // for which it rendered
};

/// The thread that renders all sessions of a device, in equal shares of its time, and the threads
/// that encode beside it. It sleeps while there is nothing to do.
class RenderLoop {
 public:
  /// Both must outlive it.
  RenderLoop(render::Engine& engine, Measurements& measurements, const RenderLoopOptions& options);
  ~RenderLoop() { stop(); }
  RenderLoop(const RenderLoop&) = delete;
  RenderLoop& operator=(const RenderLoop&) = delete;

  /// Opens a session; it is rendered from now on. The main one gets its renderer at once and
  /// renders a frame without viewers, which shows that everything works.
  /// @throws std::invalid_argument when the renderer refuses the settings
  std::shared_ptr<Session> open(SessionOptions options, PixelShare pixels);
  /// The session is not rendered any more; its pending captures fail.
  void close(const Session& session);

  /// Called once, on the render thread, after the first frame.
  void on_first_frame(std::function<void()> callback);
  bool has_rendered() const { return has_rendered_; }
  /// Work on another thread caught render::DeviceLost.
  void report_device_loss();
  /// False from the loss of the device until it is recovered.
  bool device_ready() const { return device_ready_; }
  std::uint64_t device_losses() const { return device_losses_; }
  /// Called on the render thread whenever the device was recreated.
  void on_new_device(std::function<void()> callback);
  /// Ends the threads and everything that waits for them. No callback is called afterwards.
  void stop();
  /// To this device.
  DeviceMigration& migration() { return migration_; }
  /// What decides whether the next session comes here.
  DeviceLoad load() const;
  DeviceTotals device_totals() const;
  /// Whether the image of a session moves, or did until recently.
  bool images_move() const { return still_for() < motion_end_delay; }
  /// Since the image of a session has moved last.
  Clock::duration still_for() const { return Clock::now() - moved_at_.load(); }
  /// Whether a frame is rendered, or one of a clip that plays waits for its viewers.
  bool is_occupied() const { return occupied_; }

 private:
  /// From one change to the next of a camera that a viewer moves.
  static constexpr std::chrono::milliseconds motion_end_delay{500};

  using Views = std::vector<std::shared_ptr<SessionView>>;

  void run();
  void advance_or_wait();
  Views open_views();
  Views remove_closed();
  bool advance_next(const Views& views);
  bool draw_in_turn(const std::shared_ptr<SessionView>& view);
  bool waits_for_others_in_flight(TurnKind kind) const;
  SessionView::Work advance(SessionView& view, bool may_draw);
  bool finish_a_frame(bool alone);
  void frame_finished(SessionView& view, const DeviceTurns::Frame& frame, TurnKind kind);
  /// Runs `work` of a view, whose failure is not that of others. @returns whether it succeeded
  bool attempt(SessionView& view, const std::function<void()>& work);
  std::optional<Clock::time_point> next_due(const Views& views) const;
  void report_first_frame();
  void on_device_lost(const std::string& why);
  bool recover_device(const Views& views);
  void notify_viewers(bool ready, const std::string& message);

  render::Engine& engine_;
  const Clock::duration release_after_;
  DeviceTurns turns_;  // of the render thread
  const std::shared_ptr<WakeEvent> wake_ = std::make_shared<WakeEvent>();
  Measurements& measurements_;
  DeviceMigration migration_;
  /// Guards views_, closed_, what the device does and the callbacks; never held while rendering.
  mutable std::mutex mutex_;
  Views views_;
  Views closed_;  // removed by the render thread, which may be using them
  BusyShare busy_;
  DeviceTotals device_totals_;
  std::optional<std::uint64_t> free_memory_;  // of the device, of the latest second with frames
  Clock::time_point free_memory_at_{};
  std::function<void()> on_first_frame_;
  std::function<void()> on_new_device_;
  std::atomic<bool> has_rendered_ = false;
  std::atomic<bool> device_ready_ = true;
  std::atomic<bool> loss_reported_ = false;
  std::atomic<std::uint64_t> device_losses_ = 0;
  std::atomic<Clock::time_point> moved_at_ = Clock::time_point();
  std::atomic<bool> occupied_ = false;
  RetryBackoff retry_backoff_;  // of the render thread, like the next ones
  Clock::time_point retry_at_;
  std::optional<Clock::time_point> held_back_until_;
  bool others_wait_ = false;  // a view has a frame to draw, but not yet the turn
  /// A view whose frame the device works on: those of others may begin meanwhile.
  struct InFlight {
    std::shared_ptr<SessionView> view;
    DeviceTurns::Frame frame;
    TurnKind kind = TurnKind::moving;
  };
  std::vector<InFlight> in_flight_;  // in the order in which they have begun
  Clock::time_point device_free_;    // when the device was done with the last frame
  std::atomic<bool> stopping_ = false;
  stream::JpegEncoder jpeg_;
  Worker encoder_;
  Worker capture_writer_;
  Worker preparer_;
  std::thread thread_;
};

}  // namespace heliograph::session
