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

#include "protocol/messages/messages.hpp"
#include "protocol/result.hpp"
#include "session/viewers/control.hpp"
#include "session/viewers/viewer_link.hpp"
#include "session/wake_event.hpp"
#include "stream/pacing/variant_planner.hpp"
#include "stream/pacing/viewer_pacer.hpp"

namespace heliograph::session {

inline constexpr int default_quality = 80;
inline constexpr double default_max_fps = 60.0;

/// How one viewer wants its pictures.
struct ViewerStream {
  int quality = default_quality;
  double max_fps = default_max_fps;
  bool paused = false;
  bool decodes_video = false;  // it said so in hello
  protocol::StreamCodec codec = protocol::StreamCodec::jpeg;
  protocol::StillFormat still = protocol::StillFormat::jpeg;
};

/// What a picture is sent for: to follow changes, to show how a resting one gets better, to stay.
enum class Purpose { interactive, refining, final };

/// The encodings of one picture.
struct EncodingPlan {
  std::vector<stream::VariantRequest> requests;
  std::vector<protocol::StillFormat> stills;
  int still_quality = 0;  // at least
};

struct ViewerTotals {
  std::size_t viewers = 0;
  std::size_t waiting = 0;    // frames that could not be sent yet
  std::size_t in_flight = 0;  // frames sent and not yet acknowledged
  stream::PacerTotals sent;   // those who left included
  std::chrono::microseconds mean_round_trip{0};
  double goodput = 0.0;  // bytes a second that all viewers' connections take when busy
};

/// The viewers of one session: what each may get next, and messages to them. Thread safe.
class ViewerSet {
 public:
  /// `on_capacity` is notified when a frame can be sent again.
  ViewerSet(std::size_t max_viewers, WakeEvent& on_capacity);

  /// Adds a viewer. It is sent nothing before `start`. Who only watches never has control.
  protocol::Result<void> join(const std::string& viewer, std::weak_ptr<ViewerLink> link,
                              bool read_only = false);
  void leave(const std::string& viewer);
  /// Lets a viewer go over to `there` with its stream as it is; if there is no room it stays.
  protocol::Result<void> move_to(const std::string& viewer, ViewerSet& there);
  /// Lets all viewers go, telling them why; gives their ids.
  std::vector<std::string> disconnect_all(const std::string& why);
  /// The viewer is ready for pictures; it gets the latest one there is. `codec` is the one it likes
  /// best, and it decodes JPEG.
  void start(const std::string& viewer, protocol::StreamCodec codec = protocol::StreamCodec::jpeg);

  void set_name(const std::string& viewer, std::string name);
  /// Whether a caller may change the session; empty for one without a stream.
  bool may_change(const std::string& viewer) const;
  protocol::Result<void> change_control(const protocol::SessionControl& request,
                                        const std::string& by);
  protocol::ControlMode control_mode() const;
  /// Whether one viewer is to have control and none has.
  bool control_is_free() const;
  /// Who is here, in order of arrival, as told to `you`.
  std::vector<protocol::ViewerInfo> participants(const std::string& you) const;
  /// Tells everybody who is here, each about itself.
  void announce_participants(protocol::SessionInfo session);

  protocol::Result<ViewerStream> configure(const std::string& viewer,
                                           const protocol::StreamConfigure& change);
  protocol::Result<void> acknowledge(const std::string& viewer, const protocol::StreamAck& ack);
  protocol::Result<void> subscribe(const std::string& viewer, std::chrono::milliseconds interval);
  /// Since when the oldest frame on its way to this viewer waits for its acknowledgement.
  std::optional<Clock::time_point> unacknowledged_since(const std::string& viewer) const;
  /// The frame to send to this viewer now, if any.
  std::optional<stream::OutgoingFrame> take(const std::string& viewer);

  bool empty() const;
  bool has(const std::string& viewer) const;
  /// Whether anybody but `viewer` is here who does not only watch and has said hello.
  bool has_other_participant(const std::string& viewer) const;
  /// Whether somebody could be sent a frame that is rendered now.
  bool can_accept_frame() const;
  /// Whether somebody receives pictures at all.
  bool has_active_viewer() const;
  /// Until when nobody may have another frame only because of its rate limit.
  std::optional<Clock::time_point> next_send() const;
  /// Tells those whose turn has come about waiting frames.
  void announce_due_frames();
  /// Newcomers get no picture until another is published.
  void discard_latest();
  /// Whether somebody could be sent the picture of this number, and was not yet. Numbers grow.
  bool needs_frame(std::uint64_t number) const;
  /// How to encode the picture of this number, which has so many pixels, for those who await it.
  EncodingPlan plan(std::uint64_t number, Purpose purpose, std::uint64_t pixels);
  /// Hands out the encodings of the picture that the last plan was for.
  void publish(std::uint64_t number, Purpose purpose, std::vector<stream::SharedFrame> frames);
  /// To subscribers whose turn it is; completes `stats` with what concerns each of them. A finished
  /// picture is always told about.
  void publish_stats(protocol::StatsFrame stats);

  void send_all(std::string_view text, std::string_view key);
  void send_others(const std::string& except, std::string_view text, std::string_view key);

  ViewerTotals totals() const;

 private:
  struct Viewer {
    std::weak_ptr<ViewerLink> link;
    bool read_only = false;
    std::uint64_t arrival = 0;
    std::optional<std::string> name;
    stream::ViewerPacer pacer;
    ViewerStream stream;
    bool started = false;
    bool discontinuous = false;  // its next frame has nothing in common with the last
    std::uint64_t cuts = 0;      // of the last frame that it took
    std::uint64_t offered = 0;   // number of the newest picture that it was offered or cannot have
    std::uint64_t planned = 0;   // number of the newest picture that was encoded for it
    stream::EncodingVariant variant;  // of the pictures that it gets at present
    stream::EncodingVariant moving;   // of those that it gets while something moves
    std::uint64_t last_bytes = 0;     // of the newest frame that it was offered
    std::uint32_t last_encode_us = 0;
    std::chrono::milliseconds stats_interval{0};
    Clock::time_point next_stats;
  };

  using Viewers = std::map<std::string, Viewer>;

  protocol::Result<void> check_capacity() const;
  protocol::Result<void> accept(Viewers::node_type& viewer);
  bool may_change_locked(const std::string& viewer) const;
  std::vector<protocol::ViewerInfo> participants_locked(const std::string& you) const;
  protocol::Result<Viewer*> find(const std::string& viewer);
  void offer_latest(Viewer& viewer);
  static void offer(Viewer& viewer, const stream::SharedFrame& frame);
  bool needs_frame(const Viewer& viewer, std::uint64_t number, Clock::time_point now) const;
  stream::EncodingVariant wish(Viewer& viewer, Purpose purpose) const;
  static stream::SharedFrame suited(const Viewer& viewer, Purpose purpose,
                                    const std::vector<stream::SharedFrame>& frames);
  static void announce(const Viewer& viewer);

  const std::size_t max_viewers_;
  WakeEvent& on_capacity_;
  mutable std::mutex mutex_;
  Viewers viewers_;
  stream::VariantPlanner planner_;
  std::uint64_t arrivals_ = 0;
  Control control_;
  std::vector<stream::SharedFrame> latest_;
  std::uint64_t latest_number_ = 0;
  Purpose latest_purpose_ = Purpose::interactive;
  std::uint64_t pixels_ = 0;  // of the newest picture
  stream::PacerTotals departed_;
};

}  // namespace heliograph::session
