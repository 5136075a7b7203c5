#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "protocol/messages/render_messages.hpp"
#include "scene/scene.hpp"

namespace heliograph::cli {

struct FrameSize {
  std::uint32_t width = 1280;
  std::uint32_t height = 720;
};

/// The size that a request asks for: one side gives the other by the default's aspect.
FrameSize frame_size(const protocol::RenderRequest& request);

/// One image of a scene.
struct Shot {
  scene::Camera camera;
  double seconds = 0.0;     // into the clip
  std::uint32_t frame = 0;  // in the file's name
  std::size_t camera_number = 0;
  bool cut = false;  // another view than that of the shot before: no history applies
};

/// The images of a scene, in the order in which they are rendered. `shown`: bounds of the scene as
/// it is shown, into which cameras are fitted.
/// @throws std::runtime_error where the scene lacks what the request names
std::vector<Shot> plan_shots(const scene::Scene& scene, const scene::Bounds& shown,
                             const protocol::RenderRequest& request);

/// One sentence for the user on frames that lie beyond the end of the clip; empty: there are none.
std::string note_on_clip(const scene::Scene& scene, const protocol::RenderRequest& request);

}  // namespace heliograph::cli
