#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "protocol/settings/settings.hpp"
#include "scene/scene.hpp"
#include "session/edits/scene_edits.hpp"
#include "session/state/animation_clock.hpp"
#include "stream/encoded_frame.hpp"

namespace heliograph::render {
class LitEnvironment;
class SceneResources;
struct Section;
}  // namespace heliograph::render

namespace heliograph::session {

using stream::Clock;

/// Everything that a frame depends on, as of one moment: a copy of a session's state.
struct RenderState {
  std::uint64_t version = 0;  // counts every change
  std::uint32_t rev = 0;
  Clock::time_point changed_at;
  std::shared_ptr<const render::SceneResources> resources;
  std::shared_ptr<const scene::Scene> scene;
  SceneParts parts;                                            // as edited
  EditedMembers edited_members;                                // of `parts`
  std::shared_ptr<const std::vector<std::uint32_t>> selected;  // instances; null: none
  std::shared_ptr<const render::Section> section;              // null: the scene is whole
  std::shared_ptr<const render::LitEnvironment> environment;   // null: the scene's own
  scene::Camera camera;
  std::uint64_t camera_moves = 0;
  std::uint64_t discontinuities = 0;  // jumps of the camera, and changes of the scene
  bool camera_follows = false;        // the clip moves the camera
  AnimationClock animation;
  protocol::Settings settings;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<stream::InputEcho> inputs;
  std::uint64_t reset_count = 0;              // how often all accumulated data was to be discarded
  std::optional<Clock::time_point> lockstep;  // the time in lockstep
  bool reference_started = false;             // it is rendered with or without viewers
  bool first_view = false;  // viewers see the scene without its textures, which programs do not

  Clock::time_point now() const { return lockstep ? *lockstep : Clock::now(); }
};

}  // namespace heliograph::session
