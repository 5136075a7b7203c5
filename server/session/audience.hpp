#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/messages.hpp"
#include "protocol/result.hpp"
#include "session/viewer_link.hpp"
#include "session/wakeup.hpp"
#include "stream/viewer_pacer.hpp"

namespace heliograph::session {

inline constexpr int default_quality = 80;
inline constexpr double default_max_fps = 60.0;

/// How one viewer wants its pictures.
struct ViewerStream {
  int quality = default_quality;
  double max_fps = default_max_fps;
  bool paused = false;
};

struct AudienceTotals {
  std::size_t viewers = 0;
  stream::PacerTotals sent;  // those who left included
  std::chrono::microseconds mean_round_trip{0};
  double goodput = 0.0;  // bytes a second, all viewers together
};

/// The viewers of one session: what each may get next, and messages to them. Thread safe.
class Audience {
 public:
  /// `room` is notified when a frame can be sent again.
  Audience(std::size_t max_viewers, Wakeup& room);

  /// A new viewer, by the id it gets. It is sent nothing before `start`.
  protocol::Result<std::string> join(std::weak_ptr<ViewerLink> link);
  void leave(const std::string& viewer);
  /// The viewer is ready for pictures; it gets the latest one there is.
  void start(const std::string& viewer);

  protocol::Result<ViewerStream> configure(const std::string& viewer,
                                           const protocol::StreamConfigure& change);
  protocol::Result<void> acknowledge(const std::string& viewer, const protocol::StreamAck& ack);
  protocol::Result<void> subscribe(const std::string& viewer, std::chrono::milliseconds interval);
  /// The frame to send to this viewer now, if any.
  std::optional<stream::OutgoingFrame> take(const std::string& viewer);

  /// Whether somebody could be sent a frame that is rendered now.
  bool wants_frame() const;
  /// Whether somebody receives pictures at all.
  bool watching() const;
  /// Until when nobody may have another frame only because of its rate limit.
  std::optional<Clock::time_point> next_turn() const;
  /// Tells those whose turn has come about waiting frames.
  void announce_waiting();
  /// The qualities asked for, reduced to few classes.
  std::vector<int> quality_classes() const;
  /// Hands out one picture, encoded in ascending qualities.
  void publish(std::vector<stream::SharedFrame> frames);
  void publish_stats(const protocol::StatsFrame& stats);

  void send_all(std::string_view text, std::string_view key);
  void send_others(const std::string& except, std::string_view text, std::string_view key);

  AudienceTotals totals() const;

 private:
  struct Viewer {
    std::weak_ptr<ViewerLink> link;
    stream::ViewerPacer pacer;
    ViewerStream stream;
    bool started = false;
    std::chrono::milliseconds stats_interval{0};
    Clock::time_point next_stats;
  };

  protocol::Result<Viewer*> find(const std::string& viewer);
  void offer_latest(Viewer& viewer);
  static void announce(const Viewer& viewer);

  const std::size_t max_viewers_;
  Wakeup& room_;
  mutable std::mutex mutex_;
  std::map<std::string, Viewer> viewers_;
  std::uint64_t viewers_so_far_ = 0;
  std::vector<stream::SharedFrame> latest_;
  stream::PacerTotals departed_;
};

}  // namespace heliograph::session
