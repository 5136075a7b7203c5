#include "session/session_camera.hpp"

#include <cmath>
#include <glm/trigonometric.hpp>
#include <utility>

#include "protocol/json/json_values.hpp"
#include "scene/animation/explosion.hpp"
#include "session/nodes/node_properties.hpp"

namespace heliograph::session {

using protocol::Camera;
using protocol::Result;

namespace {

/// Half the height of a sensor over the focal length: the tangent of half the field of view.
double focal_length_of(double sensor_height, double field_of_view) {
  return 0.5 * sensor_height / std::tan(glm::radians(0.5 * field_of_view));
}

/// A focal length as the field of view that it means. `sensor_height` in mm.
Result<protocol::CameraSet> with_field_of_view(protocol::CameraSet request, float sensor_height) {
  if (!request.focal_length) return request;
  if (request.vertical_fov) {
    return protocol::error::invalid("focal_length", "cannot be given beside vertical_fov");
  }
  const double shortest = focal_length_of(sensor_height, protocol::max_field_of_view);
  const double longest = focal_length_of(sensor_height, protocol::min_field_of_view);
  const double focal_length = *request.focal_length;
  if (focal_length < shortest || focal_length > longest) {
    return protocol::error::invalid(
        "focal_length", "gives no valid field of view",
        protocol::range_text({shortest, longest}) + " mm for this lens.sensor_height");
  }
  request.vertical_fov =
      static_cast<float>(glm::degrees(2.0 * std::atan(0.5 * sensor_height / focal_length)));
  return request;
}

}  // namespace

Result<Camera> SessionCamera::get() const {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> loaded = core_.require_shown_scene(); !loaded) return loaded.error();
  return core_.camera_message();
}

std::uint64_t SessionCamera::moves() const {
  const std::lock_guard lock(core_.mutex);
  return core_.shown_camera().moves();
}

template <class Request, class Change>
Result<Camera> SessionCamera::move(const Request& request, const std::string& by,
                                   const Change& change) {
  std::unique_lock lock(core_.mutex);
  if (const Result<void> loaded = core_.require_shown_scene(); !loaded) return loaded.error();
  if constexpr (requires { request.scene_rev; }) {
    if (const auto meant = core_.require_scene_of(request.scene_rev); !meant) return meant.error();
  }
  if (const Result<void> moved = change(core_.shown_camera()); !moved) return moved.error();
  core_.changed();
  const protocol::CameraChanged message{.camera = core_.camera_message(), .by = by};
  core_.notify_others_latest<protocol::notifications::camera_changed>(by, message);
  core_.pass_camera_on(std::move(lock), by);
  return message.camera;
}

Result<Camera> SessionCamera::set(const protocol::CameraSet& request, const std::string& by) {
  return move(request, by, [&](CameraState& camera) -> Result<void> {
    const auto chosen = with_field_of_view(request, core_.settings.lens.sensor_height);
    if (!chosen) return chosen.error();
    return camera.set(*chosen, *core_.shown_scene(), by);
  });
}

Result<Camera> SessionCamera::orbit(const protocol::CameraOrbit& request, const std::string& by) {
  return move(request, by, [&](CameraState& camera) { return camera.orbit(request, by); });
}

Result<Camera> SessionCamera::fit(const protocol::CameraFit& request, const std::string& by) {
  return move(request, by, [&](CameraState& camera) { return fit_locked(request, camera); });
}

Result<void> SessionCamera::fit_locked(const protocol::CameraFit& request, CameraState& camera) {
  const float explode = core_.settings.view.explode;
  scene::Bounds bounds;
  if (request.nodes) {
    const auto& scene = core_.shown_scene();
    const NodeState nodes = core_.shows_first_view() ? NodeState(scene) : core_.nodes;
    if (const auto known = nodes.check(*request.nodes, "nodes"); !known) return known.error();
    const scene::Pose pose = scene::shown_pose(*scene, nullptr, 0.0, explode);
    bounds = node_bounds(*scene, pose, nodes, *request.nodes);
    if (bounds.empty()) return protocol::error::invalid("nodes", "have no meshes to show");
  } else {
    bounds = scene::exploded_bounds(*core_.shown_scene(), explode);
  }
  camera.fit(bounds, core_.aspect());
  return {};
}

protocol::BookmarkList SessionCamera::bookmarks() const {
  const std::lock_guard lock(core_.mutex);
  return bookmarks_locked();
}

protocol::BookmarkList SessionCamera::bookmarks_locked() const {
  if (!core_.scene) return {};
  const std::string& scene = core_.scene_info.name;
  return {.scene = scene, .bookmarks = core_.bookmarks.of_scene(scene)};
}

template <class Change>
Result<protocol::BookmarkList> SessionCamera::change_bookmarks(const std::string& by,
                                                               const Change& change) {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> loaded = core_.require_scene(); !loaded) return loaded.error();
  if (const Result<void> done = change(core_.scene_info.name); !done) return done.error();
  core_.lead();
  const protocol::BookmarksChanged message{.list = bookmarks_locked(), .by = by};
  core_.notify_others_latest<protocol::notifications::bookmarks_changed>(by, message);
  return message.list;
}

Result<protocol::BookmarkList> SessionCamera::add_bookmark(const protocol::BookmarkAdd& request,
                                                           const std::string& by) {
  return change_bookmarks(by, [&](const std::string& scene) {
    return core_.bookmarks.add(scene, request, core_.camera.message(core_.rev, core_.scene_rev));
  });
}

Result<protocol::BookmarkList> SessionCamera::rename_bookmark(
    const protocol::BookmarkRename& request, const std::string& by) {
  return change_bookmarks(
      by, [&](const std::string& scene) { return core_.bookmarks.rename(scene, request); });
}

Result<protocol::BookmarkList> SessionCamera::remove_bookmark(const protocol::BookmarkName& request,
                                                              const std::string& by) {
  return change_bookmarks(
      by, [&](const std::string& scene) { return core_.bookmarks.remove(scene, request.name); });
}

}  // namespace heliograph::session
