#include "session/snapshot.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "protocol/limits.hpp"
#include "session/rendering/transparent_snapshot.hpp"

namespace heliograph::session {

using protocol::Result;

namespace {

std::uint32_t proportional(std::uint32_t side, std::uint32_t of, std::uint32_t to,
                           std::uint32_t most) {
  const double length = static_cast<double>(side) * to / of;
  return std::clamp(static_cast<std::uint32_t>(std::lround(length)), protocol::min_frame_size,
                    most);
}

protocol::SessionCreate copy_request(const Session& shown, const SnapshotView& view) {
  const protocol::SessionInfo info = shown.info({});
  const SessionLimits& limits = shown.limits();
  protocol::SessionCreate request;
  request.copy_of = shown.name();
  request.width = view.width;
  request.height = view.height;
  if (view.width && !view.height) {
    request.height = proportional(info.height, info.width, *view.width, limits.max_height);
  } else if (view.height && !view.width) {
    request.width = proportional(info.width, info.height, *view.height, limits.max_width);
  }
  return request;
}

Result<void> apply_view(Session& session, const SnapshotView& view) {
  if (view.camera) {
    const auto set = session.camera().set({.name = view.camera}, {});
    if (!set && set.error().path == "name") {
      return protocol::error::not_found("camera", set.error().reason);
    }
    if (!set) return set.error();
  }
  if (view.fit) {
    if (const auto fitted = session.camera().fit({}, {}); !fitted) return fitted.error();
  }
  if (!view.background) return {};
  const protocol::RawJson patch(nlohmann::json{{"environment", {{"visible", *view.background}}}});
  const auto patched = session.patch_settings(patch, {});
  return patched ? Result<void>() : patched.error();
}

void end_copy(SessionHost& host, const Session& session) {
  // Another client may have closed it already, and created another of its name.
  if (!session.ended()) (void)host.sessions().close(session.name(), "its snapshot was taken");
}

}  // namespace

Result<void> request_snapshot(SessionHost& host, const std::shared_ptr<Session>& shown,
                              const SnapshotView& view, CaptureRequest capture) {
  if (view.as_shown()) return shown->captures().request_capture(std::move(capture));
  Result<std::shared_ptr<Session>> created = protocol::error::internal();
  // Without a scene to load it is created at once.
  host.create_session(
      copy_request(*shown, view), {},
      [&](Result<std::shared_ptr<Session>> made) { created = std::move(made); }, shown->device());
  if (!created) return created.error();
  const std::shared_ptr<Session> copy = *created;
  capture.done = [&host, weak = std::weak_ptr<Session>(copy),
                  done = std::move(capture.done)](Result<Capture> result) {
    if (const auto session = weak.lock()) end_copy(host, *session);
    done(std::move(result));
  };
  Result<void> accepted = apply_view(*copy, view);
  if (accepted) {
    accepted = view.transparent ? request_transparent_capture(copy, std::move(capture))
                                : copy->captures().request_capture(std::move(capture));
  }
  if (!accepted) end_copy(host, *copy);
  return accepted;
}

}  // namespace heliograph::session
