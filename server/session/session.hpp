#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "protocol/messages/messages.hpp"
#include "protocol/result.hpp"
#include "session/inspection/session_annotations.hpp"
#include "session/inspection/session_measurements.hpp"
#include "session/nodes/session_nodes.hpp"
#include "session/rendering/pixel_budget.hpp"
#include "session/session_camera.hpp"
#include "session/session_captures.hpp"
#include "session/session_reference.hpp"
#include "session/session_scene.hpp"
#include "session/session_timeline.hpp"
#include "session/state/session_core.hpp"

namespace heliograph::session {

class DeviceMigration;

/// The error for a caller that may not change the session of these viewers.
protocol::Error no_control(const ViewerSet& viewers);

/// The state that viewers share and control: scene, camera, settings, size of the frames. Commands
/// take effect at once, whatever the renderer is doing; it takes the newest state for its next
/// frame, so that nothing queues up. Thread safe; SessionCore has the rule for locking. `by` is the
/// viewer that asks, empty for a caller without a stream.
class Session {
 public:
  /// `wake` is notified when there is something to do; the size of the frames is taken from
  /// `pixels`; `measurements`, which outlive the session, count refused captures.
  Session(SessionOptions options, std::shared_ptr<WakeEvent> wake, PixelShare pixels = {},
          Measurements* measurements = nullptr);

  const std::string& name() const { return core_.options.name; }
  const SessionLimits& limits() const { return core_.options.limits; }
  bool starts_empty() const { return core_.options.starts_empty; }
  /// The session that it follows with a camera of its own; empty: none.
  const std::string& follows() const { return core_.options.follows; }
  /// The index of the device that renders it.
  std::size_t device() const { return core_.options.device.value_or(0); }
  std::uint32_t rev() const;
  /// The session as `viewer` sees it.
  protocol::SessionInfo info(const std::string& viewer) const;

  // Commands, by what they change.
  SessionScene& scene() { return scene_; }
  const SessionScene& scene() const { return scene_; }
  SessionNodes& nodes() { return nodes_; }
  SessionMeasurements& measurements() { return measurements_; }
  SessionAnnotations& annotations() { return annotations_; }
  SessionCamera& camera() { return camera_; }
  SessionTimeline& timeline() { return timeline_; }
  const SessionTimeline& timeline() const { return timeline_; }
  SessionCaptures& captures() { return captures_; }
  SessionReference& reference() { return reference_; }
  ViewerSet& viewers() { return core_.viewers; }
  const ViewerSet& viewers() const { return core_.viewers; }

  protocol::SettingsState settings() const;
  protocol::Result<protocol::SettingsApplied> patch_settings(const protocol::RawJson& patch,
                                                             const std::string& by);
  /// The viewer's stream, and the size of the frames of all viewers, which is chosen for all that
  /// have asked for one: asking requires control, and a caller that is not `read_only`. A caller
  /// without a stream sets the size, until a viewer asks for another or leaves.
  protocol::Result<protocol::StreamState> configure_stream(const protocol::StreamConfigure& request,
                                                           const std::string& by,
                                                           bool read_only = false);
  /// Notifies all viewers of the participants and of control.
  void announce();
  void leave(const std::string& viewer);
  /// Moves a viewer to another session; it stays if that one is full.
  protocol::Result<void> move_to(const std::string& viewer, Session& other);

  /// Begins with the scene, camera, clip and settings of another session.
  void copy_from(const Session& other);
  /// Follows the session that `follows` names from now on, beginning with its camera.
  static void follow(const std::shared_ptr<Session>& follower, Session& leader);
  /// The camera of `follower` is that of `source` from now on, until `unfollow_camera`.
  static void follow_camera(const std::shared_ptr<Session>& follower, Session& source,
                            const std::string& by);
  static void unfollow_camera(Session& follower, Session& source);
  /// The session is removed from the registry, though it may still be referenced.
  void end();
  bool ended() const { return ended_; }
  /// A command is about to change what viewers share.
  void mark_modified() { modified_ = true; }
  /// Whether it is as it was made, all viewers have control, and no participant but `viewer` is in
  /// it; read-only viewers and those without hello are none.
  bool is_pristine(const std::string& viewer) const;
  /// Restarts the idle time: a caller needs the session, or it renders.
  void mark_used() { used_at_ = Clock::now(); }
  /// For how long it has not been used; zero while it has viewers.
  Clock::duration idle() const;

  // For the render thread.

  /// The buffers of the newest frame.
  void set_buffers(std::vector<protocol::BufferInfo> buffers);
  std::vector<protocol::BufferInfo> buffers() const;
  std::uint64_t version() const;
  RenderState render_state() const;
  /// Whether frames are due without viewers: in lockstep, or of a reference.
  bool renders_without_viewers() const;
  /// Whether all of its scene is on that device.
  bool is_on(const DeviceMigration& device) const;
  /// Brings everything that is on a lost device, or another one, to the present one. May run on any
  /// thread.
  void migrate(DeviceMigration& migration);

 private:
  protocol::SessionInfo info_locked() const;
  protocol::Result<ViewerStream> configure_viewer(const protocol::StreamConfigure& request,
                                                  const std::string& by);
  /// For viewers that want these sizes, and perhaps one more.
  FrameSize size_for(std::vector<FrameSize> wanted, std::optional<FrameSize> more = {}) const;
  bool may_resize(const std::string& by, bool read_only) const;
  void resize(FrameSize size);
  void restore_size();
  /// What belongs to a viewer that is gone.
  void discard_requests_of(const std::string& viewer);

  SessionCore core_;
  PixelShare pixels_;                          // guarded by core_.mutex
  std::vector<protocol::BufferInfo> buffers_;  // guarded by core_.mutex
  std::atomic<Clock::time_point> used_at_ = Clock::now();
  std::atomic<bool> ended_ = false;
  std::atomic<bool> modified_ = false;
  SessionScene scene_{core_};
  SessionNodes nodes_{core_};
  SessionMeasurements measurements_{core_};
  SessionAnnotations annotations_{core_};
  SessionCamera camera_{core_};
  SessionTimeline timeline_{core_};
  SessionCaptures captures_{core_};
  SessionReference reference_{core_};
};

}  // namespace heliograph::session
