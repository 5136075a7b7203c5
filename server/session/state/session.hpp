#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "protocol/messages/messages.hpp"
#include "protocol/result.hpp"
#include "protocol/settings/settings.hpp"
#include "scene/scene.hpp"
#include "session/library/loaded_scene.hpp"
#include "session/rendering/pixel_budget.hpp"
#include "session/state/animation_clock.hpp"
#include "session/state/capture.hpp"
#include "session/state/probe.hpp"
#include "session/state/scene_edits.hpp"
#include "session/state/step.hpp"
#include "session/viewers/viewer_set.hpp"
#include "session/wake_event.hpp"

namespace heliograph::render {
class LitEnvironment;
}

namespace heliograph::session {

struct SessionLimits {
  std::uint32_t max_width = 3840;
  std::uint32_t max_height = 2160;
  std::size_t max_viewers = 32;
  std::size_t max_captures = 32;  // asked for and not yet answered; as many steps beside them
};

struct SessionOptions {
  std::string name = "main";
  std::uint32_t width = 1280;
  std::uint32_t height = 720;
  protocol::Settings settings;
  SessionLimits limits;
};

/// Everything a picture depends on, as of one moment.
struct RenderState {
  std::uint64_t version = 0;  // counts every change
  std::uint32_t rev = 0;
  Clock::time_point changed_at;
  std::shared_ptr<const render::SceneResources> resources;
  std::shared_ptr<const scene::Scene> scene;
  std::shared_ptr<const SceneEdits::Lights> lights;           // null: the scene's own
  std::shared_ptr<const SceneEdits::Materials> materials;     // null: the scene's own
  std::shared_ptr<const render::LitEnvironment> environment;  // null: the scene's own
  scene::Camera camera;
  std::uint64_t cuts = 0;       // how often the picture jumped: camera, scene
  bool camera_follows = false;  // the clip carries the camera
  AnimationClock animation;
  protocol::Settings settings;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<stream::InputEcho> inputs;
  std::uint64_t reset_count = 0;  // how often everything drawn before was to be forgotten
  std::optional<Clock::time_point> lockstep;  // what the time is where it passes by steps only
  bool keep_drawing = false;  // a reference that was started, whether anybody watches or not

  Clock::time_point now() const { return lockstep ? *lockstep : Clock::now(); }
};

/// One frame that is due in lockstep.
struct StepFrame {
  std::uint64_t place = 0;  // of its step among steps, captures and probes
  double seconds = 0.0;     // that pass before it
  RenderState state;        // as it was when the step was asked for
};

class DeviceMigration;
class Measurements;

/// What a caller is told who may not change the session of this audience.
protocol::Error no_control(const ViewerSet& audience);

/// The state that viewers share and steer: scene, camera, settings, picture size. Commands take
/// effect at once, whatever the renderer is doing; it takes the newest state for its next frame, so
/// nothing queues up. Thread safe. `by` is the viewer that asks, empty for callers without stream.
class Session {
 public:
  /// `changed` is notified when there is something to do; `pixels` is what the picture's size is
  /// taken from; `measurements`, which outlive the session, count refused captures.
  Session(SessionOptions options, std::shared_ptr<WakeEvent> changed, PixelShare pixels = {},
          Measurements* measurements = nullptr);

  const std::string& name() const { return options_.name; }
  const SessionLimits& limits() const { return options_.limits; }
  ViewerSet& viewers() { return viewers_; }
  std::uint32_t rev() const;

  /// The session as told to a viewer.
  protocol::SessionInfo info(const std::string& you) const;
  /// Tells everybody in the session who is in it and has control.
  void announce();
  /// Begins with the scene, camera, clip and settings of another session.
  void copy_from(const Session& other);
  /// It is no longer among the sessions, though somebody may still hold it.
  void end();
  bool ended() const { return ended_; }
  /// Whether pictures are due though nobody watches: lockstep, or a reference.
  bool renders_without_viewers() const;
  /// Somebody is about to change what all see.
  void mark_modified() { touched_ = true; }
  /// Whether the session is as it began, belongs to nobody, and has nobody in it but `viewer`,
  /// those who only watch and those who have not said hello yet.
  bool is_pristine(const std::string& viewer) const;
  /// Somebody needs the session, or it draws: its idle time begins anew.
  void touch() { needed_at_ = Clock::now(); }
  /// How long nobody has needed it; zero while it has viewers.
  Clock::duration idle() const;

  /// The buffers of the newest picture; the renderer knows them.
  void set_buffers(std::vector<protocol::BufferInfo> buffers);
  std::vector<protocol::BufferInfo> buffers() const;

  protocol::Result<protocol::SceneInfo> scene_info() const;
  void show(LoadedScene scene, const std::string& by);
  /// Shows nothing.
  void unload(const std::string& by);

  protocol::Result<protocol::LightList> lights() const;
  protocol::Result<protocol::LightState> patch_light(const protocol::LightsPatch& request,
                                                     const std::string& by);
  protocol::Result<protocol::MaterialList> materials() const;
  protocol::Result<protocol::MaterialState> patch_material(const protocol::MaterialsPatch& request,
                                                           const std::string& by);
  /// What is in effect; the catalogue is not known here.
  protocol::EnvironmentState environment() const;
  /// `environment` goes with `name`; both empty: the scene's own.
  protocol::Result<void> set_environment(std::optional<std::string> name,
                                         std::shared_ptr<const render::LitEnvironment> environment,
                                         const std::string& by);

  protocol::Result<protocol::Camera> camera() const;
  protocol::Result<protocol::Camera> set_camera(const protocol::CameraSet& request,
                                                const std::string& by);
  protocol::Result<protocol::Camera> orbit_camera(const protocol::CameraOrbit& request,
                                                  const std::string& by);
  protocol::Result<protocol::Camera> fit_camera(const std::string& by);

  protocol::Result<protocol::AnimationState> animation() const;
  protocol::Result<protocol::AnimationState> play(const protocol::AnimationPlay& request,
                                                  const std::string& by = {});
  protocol::Result<protocol::AnimationState> pause(const std::string& by = {});
  protocol::Result<protocol::AnimationState> seek(const protocol::AnimationSeek& request,
                                                  const std::string& by = {});
  protocol::Result<protocol::AnimationState> set_rate(const protocol::AnimationRate& request,
                                                      const std::string& by = {});

  protocol::SettingsState settings() const;
  protocol::Result<protocol::SettingsApplied> patch_settings(const protocol::RawJson& patch,
                                                             const std::string& by);

  /// The size of the pictures is everybody's: changing it takes control, and `may_steer`.
  protocol::Result<protocol::StreamState> configure_stream(const protocol::StreamConfigure& request,
                                                           const std::string& by,
                                                           bool may_steer = true);
  void leave(const std::string& viewer);
  /// Lets a viewer go over to another session; if that has no room it stays.
  protocol::Result<void> move_to(const std::string& viewer, Session& there);

  /// Refused at once where nothing would come of it.
  protocol::Result<void> request_capture(CaptureRequest request);
  /// The captures asked for since the last call.
  std::vector<CaptureRequest> take_captures();
  /// Enters lockstep, where the session is not in it yet: what is drawn from then on is as if
  /// nothing had been drawn before, and depends on nothing but the state and the steps.
  protocol::Result<void> request_step(StepRequest request);
  /// Leaves lockstep.
  protocol::StepState run_freely(const std::string& by = {});
  bool in_lockstep() const;
  /// For the render thread: lets the time of the next frame pass; nothing where none is due, or
  /// where something is to be read before it: `waiting` is the first place of what is known to
  /// wait. After it is drawn comes end_step.
  std::optional<StepFrame> begin_step(std::optional<std::uint64_t> waiting);
  /// Whether steps are due before this place; without one, any.
  bool step_due(std::optional<std::uint64_t> place) const;
  void end_step(const StepFrame& frame, std::uint32_t samples);
  void fail_steps(const protocol::Error& why);

  protocol::Result<protocol::ReferenceState> start_reference(
      const protocol::ReferenceStart& request, const std::string& by);
  protocol::Result<protocol::ReferenceState> stop_reference(const std::string& by);
  protocol::ReferenceState reference() const;
  /// What the newest picture is: of which version of the state, with how many samples.
  void report_frame(std::uint64_t version, std::uint32_t samples, bool converged);

  protocol::Result<void> request_probe(Probe probe);
  /// The probes asked for since the last call.
  std::vector<Probe> take_probes();

  /// Brings everything that is on a lost device onto the present one.
  void renew(DeviceMigration& renewal);

  std::uint64_t version() const;
  RenderState render_state() const;

 private:
  void changed(bool new_revision = true);
  RenderState whole_state() const;
  protocol::SessionInfo info_locked() const;
  /// Of a viewer that is gone.
  void forget(const std::string& viewer);
  protocol::Result<void> require_scene() const;
  protocol::Result<void> accept_capture(CaptureRequest request);
  protocol::Result<protocol::SettingsApplied> patch_locked(const protocol::RawJson& patch,
                                                           const std::string& by);
  protocol::ReferenceState reference_message() const;
  protocol::Camera camera_message() const;
  protocol::Camera moved_camera(const scene::Camera& camera, std::optional<std::string> name,
                                const std::string& by);
  void enter_lockstep(const std::string& by);
  void tell_lockstep(const std::string& by);
  /// Its turn in lockstep, where what was asked for takes place in that order.
  std::optional<std::uint64_t> next_place();
  bool is_read_before(std::uint64_t place) const;
  void drop_steps(const protocol::Error& why,
                  const std::function<bool(const StepRequest&)>& unwanted);
  std::vector<StepRequest> take_steps(const std::function<bool(const StepRequest&)>& unwanted);
  protocol::StepState step_message(const RenderState& shown) const;
  AnimationClock rewound_clock() const;
  protocol::AnimationState set_clock(const AnimationClock& clock, const std::string& by);
  protocol::AnimationState tell_animation(const std::string& by);
  protocol::AnimationState animation_message() const;
  float aspect() const;

  const SessionOptions options_;
  const std::shared_ptr<WakeEvent> changed_;
  Measurements* const measurements_;
  std::atomic<Clock::time_point> needed_at_ = Clock::now();
  std::atomic<bool> ended_ = false;
  std::atomic<bool> touched_ = false;
  ViewerSet viewers_;

  mutable std::mutex mutex_;
  PixelShare pixels_;
  std::vector<protocol::BufferInfo> buffers_;
  RenderState state_;
  std::optional<std::string> camera_name_;
  std::shared_ptr<const scene::Scene> scene_;
  protocol::SceneInfo scene_info_;
  SceneEdits edits_;
  std::optional<std::string> environment_name_;
  std::vector<Probe> probes_;
  struct DueStep {
    StepRequest request;
    std::uint64_t place = 0;
    std::uint64_t changes = 0;  // how many there had been
    bool begun = false;         // a frame that has not ended
    RenderState state;
  };
  std::deque<DueStep> steps_;
  std::uint64_t changes_ = 0;  // of the state by commands
  std::uint64_t places_ = 0;   // given to steps, captures and probes
  struct StepTotals {
    std::uint64_t frames = 0;
    std::uint32_t samples = 0;
  };
  StepTotals step_totals_;  // since lockstep was entered
  struct FrameReport {
    std::uint64_t version = 0;
    std::uint32_t samples = 0;
    bool converged = false;
  };
  FrameReport newest_frame_;
  /// What reference.start changes, as it was; nothing where no reference was started.
  struct BeforeReference {
    protocol::Settings::Reference reference;
    protocol::Settings::Accumulation accumulation;
  };
  std::optional<BeforeReference> before_reference_;
  std::map<std::string, std::uint32_t> input_seqs_;  // by viewer
  std::vector<CaptureRequest> captures_;
  /// How many are not yet answered, wherever they are.
  const std::shared_ptr<std::atomic<std::size_t>> open_captures_ =
      std::make_shared<std::atomic<std::size_t>>(0);
};

}  // namespace heliograph::session
