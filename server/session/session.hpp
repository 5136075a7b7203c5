#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "protocol/messages.hpp"
#include "protocol/result.hpp"
#include "protocol/settings.hpp"
#include "scene/scene.hpp"
#include "session/animation_clock.hpp"
#include "session/audience.hpp"
#include "session/capture.hpp"
#include "session/loaded_scene.hpp"
#include "session/pixel_budget.hpp"
#include "session/wakeup.hpp"

namespace heliograph::session {

struct SessionLimits {
  std::uint32_t max_width = 3840;
  std::uint32_t max_height = 2160;
  std::size_t max_viewers = 32;
  std::size_t max_captures = 16;  // waiting at one time
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
  scene::Camera camera;
  std::uint64_t cuts = 0;       // how often the picture jumped: camera, scene
  bool camera_follows = false;  // the clip carries the camera
  AnimationClock animation;
  protocol::Settings settings;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<stream::InputEcho> inputs;
};

/// The state that viewers share and steer: scene, camera, settings, picture size. Commands take
/// effect at once, whatever the renderer is doing; it takes the newest state for its next frame, so
/// nothing queues up. Thread safe. `by` is the viewer that asks, empty for callers without stream.
class Session {
 public:
  /// `changed` is notified when there is something to do; `pixels` is what the picture's size is
  /// taken from.
  Session(SessionOptions options, std::shared_ptr<Wakeup> changed, PixelShare pixels = {});

  const std::string& name() const { return options_.name; }
  const SessionLimits& limits() const { return options_.limits; }
  Audience& audience() { return audience_; }
  std::uint32_t rev() const;

  /// What `view.buffer` and captures may name; the renderer knows it.
  void set_buffers(std::vector<protocol::BufferInfo> buffers);
  std::vector<protocol::BufferInfo> buffers() const;

  protocol::Result<protocol::SceneInfo> scene_info() const;
  void show(LoadedScene scene, const std::string& by);

  protocol::Result<protocol::Camera> camera() const;
  protocol::Result<protocol::Camera> set_camera(const protocol::CameraSet& request,
                                                const std::string& by);
  protocol::Result<protocol::Camera> fit_camera(const std::string& by);

  protocol::Result<protocol::AnimationState> animation() const;
  protocol::Result<protocol::AnimationState> play(const protocol::AnimationPlay& request);
  protocol::Result<protocol::AnimationState> pause();
  protocol::Result<protocol::AnimationState> seek(const protocol::AnimationSeek& request);
  protocol::Result<protocol::AnimationState> set_rate(const protocol::AnimationRate& request);

  protocol::SettingsState settings() const;
  protocol::Result<protocol::SettingsApplied> patch_settings(const protocol::RawJson& patch,
                                                             const std::string& by);

  protocol::Result<protocol::StreamState> configure_stream(const protocol::StreamConfigure& request,
                                                           const std::string& by);
  void leave(const std::string& viewer);
  /// Lets a viewer go over to another session; if that has no room it stays.
  protocol::Result<void> hand_over(const std::string& viewer, Session& there);

  protocol::Result<void> request_capture(CaptureRequest request);
  /// The captures asked for since the last call.
  std::vector<CaptureRequest> take_captures();

  std::uint64_t version() const;
  RenderState render_state() const;

 private:
  void changed(bool new_revision = true);
  protocol::Result<void> check_buffer(const std::string& buffer, const std::string& path) const;
  protocol::Result<void> require_scene() const;
  protocol::Camera camera_message() const;
  protocol::Camera moved_camera(const scene::Camera& camera, std::optional<std::string> name,
                                const std::string& by);
  AnimationClock rewound_clock() const;
  protocol::AnimationState set_clock(const AnimationClock& clock);
  protocol::AnimationState animation_message() const;
  float aspect() const;

  const SessionOptions options_;
  const std::shared_ptr<Wakeup> changed_;
  Audience audience_;

  mutable std::mutex mutex_;
  PixelShare pixels_;
  std::vector<protocol::BufferInfo> buffers_;
  RenderState state_;
  std::optional<std::string> camera_name_;
  std::shared_ptr<const scene::Scene> scene_;
  protocol::SceneInfo scene_info_;
  std::map<std::string, std::uint32_t> input_seqs_;  // by viewer
  std::vector<CaptureRequest> captures_;
};

}  // namespace heliograph::session
