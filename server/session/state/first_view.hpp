#pragma once

#include <cstdint>
#include <memory>

#include "scene/scene.hpp"
#include "session/state/camera_state.hpp"
#include "session/state/render_state.hpp"

namespace heliograph::session {

/// A scene without its textures that viewers see while it is being loaded. The session's scene is
/// still the one before: of all methods only those of the camera know of this one.
struct FirstView {
  /// Makes the state one of this scene, without what was changed in the session's own.
  void replace(RenderState& state) const {
    state.first_view = true;
    state.scene = scene;
    state.resources = resources;
    state.parts = {};
    state.edited_members = {};
    state.selected = nullptr;
    state.section = nullptr;
    state.animation = {};
    state.camera = camera.camera();
    state.camera_moves = camera.moves();
    state.discontinuities = camera.discontinuities();
    state.camera_follows = false;
    state.inputs = camera.inputs();
  }

  std::shared_ptr<const scene::Scene> scene;
  std::shared_ptr<const render::SceneResources> resources;
  CameraState camera;           // becomes the session's with the whole scene
  std::uint32_t scene_rev = 0;  // likewise
};

}  // namespace heliograph::session
