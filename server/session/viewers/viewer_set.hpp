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
#include "session/viewers/common_size.hpp"
#include "session/viewers/control.hpp"
#include "session/viewers/frame_purpose.hpp"
#include "session/viewers/viewer_link.hpp"
#include "session/wake_event.hpp"
#include "stream/pacing/variant_planner.hpp"
#include "stream/pacing/viewer_pacer.hpp"

namespace heliograph::session {

inline constexpr int default_quality = 80;
inline constexpr double default_max_fps = 60.0;

/// The stream that one viewer requested.
struct ViewerStream {
  int quality = default_quality;
  double max_fps = default_max_fps;
  bool paused = false;
  bool decodes_video = false;  // agreed on in hello
  protocol::StreamCodec codec = protocol::StreamCodec::jpeg;
  protocol::StillFormat still = protocol::StillFormat::jpeg;
  bool depth = false;
};

/// How to encode one frame.
struct EncodingPlan {
  std::vector<stream::VariantRequest> requests;
  std::vector<protocol::StillFormat> stills;
  int still_quality = 0;  // lower bound
};

struct ViewerTotals {
  std::size_t viewers = 0;
  std::size_t waiting = 0;    // frames that could not be sent yet
  std::size_t in_flight = 0;  // frames sent and not yet acknowledged
  stream::PacerTotals sent;   // viewers that left included
  std::chrono::microseconds mean_round_trip{0};
  double goodput = 0.0;  // bytes per second of all viewers' connections when busy
};

/// The viewers of one session: what each may get next, and messages to them. Thread safe.
class ViewerSet {
 public:
  /// `on_capacity` is notified when a frame can be sent again.
  ViewerSet(std::size_t max_viewers, WakeEvent& on_capacity);

  /// Adds a viewer. It is sent nothing before `start`. A read-only viewer never has control.
  protocol::Result<void> join(const std::string& viewer, std::weak_ptr<ViewerLink> link,
                              bool read_only = false);
  void leave(const std::string& viewer);
  /// Moves a viewer to `other` with its stream as it is; if that is full it stays.
  protocol::Result<void> move_to(const std::string& viewer, ViewerSet& other);
  /// Disconnects all viewers with this reason; gives their ids.
  std::vector<std::string> disconnect_all(const std::string& reason);
  /// The viewer is ready for frames; it gets the latest one. `codec` is the one that it prefers; it
  /// decodes JPEG, too.
  void start(const std::string& viewer, protocol::StreamCodec codec = protocol::StreamCodec::jpeg);

  void set_name(const std::string& viewer, std::string name);
  /// Its display name, if it has one.
  std::optional<std::string> name_of(const std::string& viewer) const;
  /// Whether a caller may change the session; empty for one without a stream.
  bool may_change(const std::string& viewer) const;
  protocol::Result<void> change_control(const protocol::SessionControl& request,
                                        const std::string& by);
  protocol::ControlMode control_mode() const;
  /// Whether control is exclusive and no viewer holds it.
  bool control_is_free() const;
  /// All viewers in order of arrival, as described to `you`.
  std::vector<protocol::ViewerInfo> participants(const std::string& you) const;
  /// Notifies all viewers of the participants; each finds itself marked.
  void announce_participants(protocol::SessionInfo session);

  protocol::Result<ViewerStream> configure(const std::string& viewer,
                                           const protocol::StreamConfigure& change);
  /// The frame size that suits the viewer's window.
  void want_size(const std::string& viewer, FrameSize size);
  /// Those of all viewers that have told, but for one.
  std::vector<FrameSize> wanted_sizes(const std::string& except = {}) const;
  protocol::Result<void> acknowledge(const std::string& viewer, const protocol::StreamAck& ack);
  protocol::Result<void> subscribe(const std::string& viewer, std::chrono::milliseconds interval);
  /// Since when the oldest frame in flight to this viewer waits for its acknowledgement.
  std::optional<Clock::time_point> unacknowledged_since(const std::string& viewer) const;
  /// The frame to send to this viewer now, if any.
  std::optional<stream::OutgoingFrame> take(const std::string& viewer);

  bool empty() const;
  bool has(const std::string& viewer) const;
  /// Whether there is another viewer than `viewer` that is not read-only and has said hello.
  bool has_other_participant(const std::string& viewer) const;
  /// Whether any viewer could be sent a frame that is rendered now.
  bool can_accept_frame() const;
  /// Likewise that frame and one that is ready so long after it.
  bool can_accept_two_frames(Clock::duration apart) const;
  /// Whether a viewer that is not paused asked for the depth of frames.
  bool wants_depth() const;
  /// Whether any viewer is started and not paused.
  bool has_active_viewer() const;
  /// When the next viewer may be sent a frame again that only its rate limit holds back.
  std::optional<Clock::time_point> next_send() const;
  /// Announces queued frames to viewers that may be sent them now.
  void announce_due_frames();
  /// New viewers get no frame until another is published.
  void discard_latest();
  /// Whether a viewer could be sent the frame of this number, and was not yet. Numbers increase.
  bool needs_frame(std::uint64_t number) const;
  /// The JPEG that every viewer would be sent of such a frame now; absent: some would be sent
  /// something else than others, or there are no viewers.
  std::optional<stream::EncodingVariant> common_jpeg(FramePurpose purpose);
  /// How to encode the frame of this number, which has so many pixels, for viewers that need it.
  /// `made`: the JPEG that there is of it. Those are sent it whose link might have been given it:
  /// what their link is given by now comes with the next frame.
  EncodingPlan plan(std::uint64_t number, FramePurpose purpose, std::uint64_t pixels,
                    const std::optional<stream::EncodingVariant>& made = {});
  /// Distributes the encodings of the frame that the last plan was for.
  void publish(std::uint64_t number, FramePurpose purpose, std::vector<stream::SharedFrame> frames);
  /// Sends `stats`, completed for each viewer, to subscribers whose interval has passed; the stats
  /// of a final frame to all subscribers.
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
    std::optional<FrameSize> wanted;
    bool started = false;
    bool discontinuous = false;         // its next frame does not continue the last one
    std::uint64_t discontinuities = 0;  // of the last frame that it took
    std::uint64_t offered = 0;  // number of the newest frame that it was offered or cannot have
    std::uint64_t planned = 0;  // number of the newest frame that was encoded for it
    stream::EncodingVariant variant;  // of the frames that it gets at present
    stream::EncodingVariant moving;   // of those that it gets while the image changes
    std::uint64_t last_bytes = 0;     // of the newest frame that it was offered
    std::uint32_t last_encode_us = 0;
    std::chrono::milliseconds stats_interval{0};
    Clock::time_point next_stats;
  };

  using Viewers = std::map<std::string, Viewer>;

  protocol::Result<void> check_capacity() const;
  protocol::Result<void> accept(Viewers::node_type& viewer);
  bool may_change_locked(const std::string& viewer) const;
  std::vector<protocol::ViewerInfo> describe_participants(const std::string& you) const;
  protocol::Result<Viewer*> find(const std::string& viewer);
  void offer_latest(Viewer& viewer);
  static void offer(Viewer& viewer, const stream::SharedFrame& frame);
  bool viewer_needs_frame(const Viewer& viewer, std::uint64_t number, Clock::time_point now) const;
  stream::EncodingVariant requested_variant(Viewer& viewer, FramePurpose purpose) const;
  /// Whether a JPEG that was made of such a frame before will do for the viewer.
  static bool takes(const Viewer& viewer, FramePurpose purpose,
                    const stream::EncodingVariant& made);
  static stream::SharedFrame find_encoding(const Viewer& viewer, FramePurpose purpose,
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
  FramePurpose latest_purpose_ = FramePurpose::interactive;
  std::uint64_t pixels_ = 0;  // of the newest frame
  stream::PacerTotals departed_;
};

}  // namespace heliograph::session
