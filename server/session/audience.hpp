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

  /// Adds a viewer. It is sent nothing before `start`.
  protocol::Result<void> join(const std::string& viewer, std::weak_ptr<ViewerLink> link);
  void leave(const std::string& viewer);
  /// Lets a viewer go over to `there` with its stream as it is; if there is no room it stays.
  protocol::Result<void> hand_over(const std::string& viewer, Audience& there);
  /// Lets all viewers go, telling them why; gives their ids.
  std::vector<std::string> dismiss_all(const std::string& why);
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
    bool came_over = false;  // its next frame has nothing in common with the last
    std::chrono::milliseconds stats_interval{0};
    Clock::time_point next_stats;
  };

  using Viewers = std::map<std::string, Viewer>;

  protocol::Result<void> check_room() const;
  protocol::Result<void> take_in(Viewers::node_type& viewer);
  protocol::Result<Viewer*> find(const std::string& viewer);
  void offer_latest(Viewer& viewer);
  static void announce(const Viewer& viewer);

  const std::size_t max_viewers_;
  Wakeup& room_;
  mutable std::mutex mutex_;
  Viewers viewers_;
  std::vector<stream::SharedFrame> latest_;
  stream::PacerTotals departed_;
};

}  // namespace heliograph::session
