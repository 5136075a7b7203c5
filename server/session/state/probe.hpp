#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "protocol/result.hpp"

namespace heliograph::render {
class Renderer;
}

namespace heliograph::session {

struct RenderState;

/// Something to read from a picture that shows a session's state, on the render thread.
struct Probe {
  /// In lockstep: its place among the steps, given by the session.
  std::optional<std::uint64_t> place;
  /// Called once, with the renderer right after it drew that state. Returns at once.
  std::function<void(render::Renderer&, const RenderState&)> read;
  /// Called instead where there is no such picture.
  std::function<void(protocol::Error)> fail;
};

}  // namespace heliograph::session
