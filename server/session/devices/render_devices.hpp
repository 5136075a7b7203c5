#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "render/api/devices.hpp"
#include "session/rendering/render_loop.hpp"

namespace heliograph::session {

/// The devices of a server: a render loop for each. A session is placed on one of them when it is
/// opened and stays there.
class RenderDevices {
 public:
  /// The engines, at least one, must outlive it.
  RenderDevices(const render::Engines& engines, Clock::duration release_after);

  std::size_t count() const { return loops_.size(); }
  render::Engine& engine(std::size_t device) const { return engines_[device]; }
  RenderLoop& loop(std::size_t device) { return *loops_[device]; }
  const RenderLoop& loop(std::size_t device) const { return *loops_[device]; }

  /// Opens a session on the device of `options`, or where there is room; see RenderLoop::open.
  std::shared_ptr<Session> open(SessionOptions options, PixelShare pixels);
  void close(const Session& session);

  /// Whether a frame has been rendered.
  bool has_rendered() const { return main_loop().has_rendered(); }
  /// Whether a device works.
  bool ready() const;
  /// Whether the image of a session moves, or did until recently.
  bool images_move() const;
  /// Since an image of any device moved.
  Clock::duration still_for() const;
  /// Whether any device is; see RenderLoop::is_occupied.
  bool are_occupied() const;
  /// Called once, after the first frame.
  void on_first_frame(std::function<void()> callback);
  RenderTotals totals() const { return measurements_.totals(); }
  void stop();

 private:
  /// The first session is placed there.
  const RenderLoop& main_loop() const { return *loops_.front(); }
  std::size_t place(const SessionOptions& options) const;

  const render::Engines engines_;
  Measurements measurements_;
  std::vector<std::unique_ptr<RenderLoop>> loops_;  // by device
};

}  // namespace heliograph::session
