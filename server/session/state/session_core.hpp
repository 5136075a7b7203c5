#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "protocol/json/jsonrpc.hpp"
#include "protocol/messages/messages.hpp"
#include "protocol/result.hpp"
#include "scene/scene.hpp"
#include "session/edits/scene_edits.hpp"
#include "session/edits/section_planes.hpp"
#include "session/inspection/annotation_set.hpp"
#include "session/inspection/measurement_set.hpp"
#include "session/nodes/node_state.hpp"
#include "session/state/bookmarks.hpp"
#include "session/state/camera_following.hpp"
#include "session/state/camera_state.hpp"
#include "session/state/capture_queue.hpp"
#include "session/state/first_view.hpp"
#include "session/state/reference_mode.hpp"
#include "session/state/render_state.hpp"
#include "session/state/session_options.hpp"
#include "session/state/timeline.hpp"
#include "session/viewers/viewer_set.hpp"
#include "session/wake_event.hpp"

namespace heliograph::session {

class Measurements;

/// The state of one session and the rules that all changes of it follow. Only Session and its
/// command groups (SessionCamera ...) use it.
///
/// Locking: `mutex` guards every member below it; the parts do not lock. A command locks it once,
/// for the whole of its change: check, apply to the part, `changed`, `notify_others`. Notifications
/// are sent under the lock, so that no viewer receives the older of two states last. Callbacks of
/// requests (`done`, `fail`) are called after it is released. Order of locks: `mutex`, then that of
/// `viewers`. Whether a caller has control is checked before a command, by the dispatcher's gate;
/// only the size of frames is checked here, since stream.configure is for all viewers.
///
/// A session may be followed by others, which have its scene, settings and time with a camera of
/// their own: `changed` and `notify_others` pass changes on to them, under both locks, that of the
/// leader first; a follower leads no one. The cameras of these may take over those of others of
/// them or of the leader. Who takes over whose changes, so that no order of locks would hold:
/// `lead_camera` is called with no session's lock, and takes one at a time. A camera therefore
/// comes with the version that its session had, and no follower goes back to an older one.
struct SessionCore {
  SessionCore(SessionOptions session_options, std::shared_ptr<WakeEvent> wake_event,
              Measurements* session_measurements);

  /// The state was changed. `new_revision`: by a command, so that clients see another revision.
  void changed(bool new_revision = true);
  /// Passes what followers share with this session on to them.
  void lead() const;
  /// Takes over what followers share with this session, if it differs; under the leader's lock.
  void follow(const SessionCore& leader);
  /// The camera for those that take it over; for no one while viewers see the scene of
  /// `first_view`, since others see the one before. Under the lock.
  LedCamera led_camera() const;
  /// Passes it on to these, and to those that take over theirs; without any session's lock. `by`:
  /// the viewer that has moved it.
  static void lead_camera(const LedCamera& led, const std::string& by);
  /// Gives up `lock`, this session's, and passes its camera on.
  void pass_camera_on(std::unique_lock<std::mutex> lock, const std::string& by) const;
  /// Passes on the cameras of this session and of its followers, after all have taken over a scene;
  /// without any session's lock. What moved while only some had it was not passed on.
  void lead_cameras(const std::string& by) const;
  /// Takes over a camera, if the link still holds, the scene is its own and it has no newer one;
  /// gives what is to be passed on then. Locks.
  std::optional<LedCamera> take_camera(const LedCamera& led, std::uint64_t link,
                                       const std::string& by);
  /// Begins a link, by the number that is returned, or ends the one there is: cameras that others
  /// bring are not taken any more. Locks.
  std::uint64_t renew_camera_link();
  /// Everything that a frame depends on.
  RenderState snapshot() const;
  /// Whether viewers see `first_view`. What is for programs shows the session's own scene: steps
  /// in lockstep, and a reference.
  bool shows_first_view() const {
    return first_view && !timeline.in_lockstep() && !reference.started();
  }
  /// What the camera's methods act on.
  const std::shared_ptr<const scene::Scene>& shown_scene() const {
    return shows_first_view() ? first_view->scene : scene;
  }
  CameraState& shown_camera() { return shows_first_view() ? first_view->camera : camera; }
  const CameraState& shown_camera() const {
    return shows_first_view() ? first_view->camera : camera;
  }
  std::uint32_t shown_scene_rev() const {
    return shows_first_view() ? first_view->scene_rev : scene_rev;
  }
  protocol::Camera camera_message() const { return shown_camera().message(rev, shown_scene_rev()); }
  /// Tells the camera to all viewers, also to the one that has made the change: it did not ask for
  /// another camera.
  void tell_camera(const std::string& by);
  /// The same if viewers see the other one of the two scenes since the change, where no viewer has
  /// moved the camera. `before`: what shows_first_view() was.
  void tell_camera_of_other_scene(bool before);
  /// Whether an input is meant for the scene that is shown: `asked` is its member scene_rev.
  protocol::Result<void> require_scene_of(const std::optional<std::uint32_t>& asked) const;
  protocol::Result<void> require_scene() const;
  /// One that the camera's methods act on.
  protocol::Result<void> require_shown_scene() const;
  protocol::Result<protocol::SettingsApplied> patch_settings(const protocol::RawJson& patch,
                                                             const std::string& by);
  /// width / height
  float aspect() const { return static_cast<float>(width) / static_cast<float>(height); }
  /// What its scene is a part of.
  ScenePart part() const { return {.name = scene_info.name, .part = scene_info.scene}; }
  /// The position of its clip now.
  double clip_seconds() const;

  /// Sends a notification to all viewers but `by`, which made the change.
  template <class Notification>
  void notify_others(const std::string& by, const typename Notification::Params& params) {
    viewers.send_others(by, protocol::make_notification<Notification>(params), {});
    tell_followers<Notification>(params, {});
  }
  /// The same for a notification that holds a whole state: it replaces an older one that is queued.
  template <class Notification>
  void notify_others_latest(const std::string& by, const typename Notification::Params& params) {
    viewers.send_others(by, protocol::make_notification<Notification>(params), Notification::name);
    tell_followers<Notification>(params, Notification::name);
  }
  /// Sends a notification to the viewers of all followers, with their own revisions.
  template <class Notification>
  void tell_followers(typename Notification::Params params, std::string_view key) {
    if constexpr (!std::is_same_v<Notification, protocol::notifications::camera_changed> &&
                  !std::is_same_v<Notification, protocol::notifications::lockstep_changed>) {
      for (const auto& weak : followers) {
        const auto follower = weak.lock();
        if (!follower) continue;
        const std::lock_guard lock(follower->mutex);
        if constexpr (requires { params.rev; }) params.rev = follower->rev;
        if constexpr (requires { params.animation.rev; }) params.animation.rev = follower->rev;
        follower->viewers.send_all(protocol::make_notification<Notification>(params), key);
      }
    }
  }

  const SessionOptions options;
  const std::shared_ptr<WakeEvent> wake;
  Measurements* const measurements;
  ViewerSet viewers;

  mutable std::mutex mutex;
  std::uint64_t version = 1;
  std::uint32_t rev = 1;
  std::uint64_t changes = 0;  // calls of `changed`
  Clock::time_point changed_at = Clock::now();

  std::uint32_t width = 0;
  std::uint32_t height = 0;
  protocol::Settings settings;
  std::shared_ptr<const scene::Scene> scene;
  std::shared_ptr<const render::SceneResources> resources;
  std::uint64_t scene_loads = 0;  // and unloads; other textures of a scene are none
  std::uint32_t scene_rev = 1;    // revision from which on `scene` is shown
  protocol::SceneInfo scene_info;
  SceneEdits edits;
  NodeState nodes;
  SectionPlanes section;
  std::optional<std::string> environment_name;  // with `environment`: null where the scene's own
  std::shared_ptr<const render::LitEnvironment> environment;
  CameraState camera;
  std::optional<FirstView> first_view;
  Bookmarks bookmarks;
  MeasurementSet measured;
  AnnotationSet annotations;
  Timeline timeline;
  CaptureQueue captures;
  ReferenceMode reference;
  std::vector<std::weak_ptr<SessionCore>> followers;
  std::vector<CameraFollower> camera_followers;
  CameraLink camera_link;
};

}  // namespace heliograph::session
