#include "session/session_reference.hpp"

namespace heliograph::session {

using protocol::ReferenceState;
using protocol::Result;

Result<ReferenceState> SessionReference::start(const protocol::ReferenceStart& request,
                                               const std::string& by) {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> loaded = core_.require_scene(); !loaded) return loaded.error();
  const protocol::Settings before = core_.settings;
  const auto applied = core_.patch_settings(ReferenceMode::start_patch(request), by);
  if (!applied) return applied.error();
  const bool first_view_shown = core_.shows_first_view();
  core_.reference.start(before);
  // Another revision only where the camera that clients know is another one.
  core_.changed(core_.shows_first_view() != first_view_shown);
  core_.tell_camera_of_other_scene(first_view_shown);
  return state_locked();
}

Result<ReferenceState> SessionReference::stop(const std::string& by) {
  const std::lock_guard lock(core_.mutex);
  const auto applied = core_.patch_settings(core_.reference.stop_patch(), by);
  if (!applied) return applied.error();
  return state_locked();
}

ReferenceState SessionReference::state() const {
  const std::lock_guard lock(core_.mutex);
  return state_locked();
}

ReferenceState SessionReference::state_locked() const {
  return core_.reference.state(core_.settings, core_.version, core_.rev);
}

void SessionReference::report_frame(std::uint64_t version, std::uint32_t samples, bool converged) {
  const std::lock_guard lock(core_.mutex);
  core_.reference.report_frame(version, samples, converged);
}

}  // namespace heliograph::session
