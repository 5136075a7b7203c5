#include "session/state/session_core.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "protocol/settings/settings_json.hpp"
#include "render/api/buffer_names.hpp"

namespace heliograph::session {

using protocol::Result;

SessionCore::SessionCore(SessionOptions session_options, std::shared_ptr<WakeEvent> wake_event,
                         Measurements* session_measurements)
    : options(std::move(session_options)),
      wake(std::move(wake_event)),
      measurements(session_measurements),
      viewers(options.limits.max_viewers, *wake),
      width(std::min(options.width, options.limits.max_width)),
      height(std::min(options.height, options.limits.max_height)),
      settings(options.settings),
      timeline(options.limits.max_captures),
      captures(options.limits.max_captures) {}

void SessionCore::changed(bool new_revision) {
  ++version;
  ++changes;
  if (new_revision) ++rev;
  changed_at = Clock::now();
  wake->notify();
  lead();
}

void SessionCore::lead() const {
  for (const auto& weak : followers) {
    if (const auto follower = weak.lock()) follower->follow(*this);
  }
}

void SessionCore::follow(const SessionCore& leader) {
  const std::lock_guard lock(mutex);
  const AnimationClock clock = timeline.clock();
  timeline.follow(leader.timeline);
  bookmarks = leader.bookmarks;
  measured = leader.measured;
  annotations = leader.annotations;
  const bool same =
      resources == leader.resources && scene == leader.scene && settings == leader.settings &&
      environment == leader.environment && edits.device_lights() == leader.edits.device_lights() &&
      edits.device_materials() == leader.edits.device_materials() &&
      nodes.hidden_instances() == leader.nodes.hidden_instances() &&
      nodes.isolated() == leader.nodes.isolated() && nodes.selected() == leader.nodes.selected() &&
      section.get() == leader.section.get() && clock == timeline.clock();
  const bool loaded = std::exchange(scene_loads, leader.scene_loads) != leader.scene_loads;
  if (same) return;
  const bool other_scene = loaded && scene != leader.scene;
  if (other_scene) camera.copy_from(leader.camera);
  scene = leader.scene;
  resources = leader.resources;
  scene_info = leader.scene_info;
  edits = leader.edits;
  nodes = leader.nodes;
  section = leader.section;
  environment = leader.environment;
  environment_name = leader.environment_name;
  settings = leader.settings;
  changed();
  if (other_scene) scene_rev = rev;
}

LedCamera SessionCore::led_camera() const {
  if (shows_first_view()) return {};
  return {.camera = camera,
          .version = version,
          .scene_loads = scene_loads,
          .followers = camera_followers};
}

void SessionCore::lead_camera(const LedCamera& led, const std::string& by) {
  for (const auto& [weak, link] : led.followers) {
    const auto follower = weak.lock();
    if (!follower) continue;
    if (const auto passed = follower->take_camera(led, link, by)) lead_camera(*passed, by);
  }
}

std::optional<LedCamera> SessionCore::take_camera(const LedCamera& led, std::uint64_t link,
                                                  const std::string& by) {
  const std::lock_guard lock(mutex);
  if (link != camera_link.number || led.version <= camera_link.version) return {};
  if (led.scene_loads != scene_loads) return {};  // lead_cameras comes when both have the newer one
  camera_link.version = led.version;
  camera.take_over(led.camera,
                   std::exchange(camera_link.discontinuities, led.camera.discontinuities()));
  changed();
  notify_others_latest<protocol::notifications::camera_changed>(
      {}, {.camera = camera_message(), .by = by});
  return led_camera();
}

void SessionCore::pass_camera_on(std::unique_lock<std::mutex> lock, const std::string& by) const {
  const LedCamera led = led_camera();
  lock.unlock();
  lead_camera(led, by);
}

void SessionCore::lead_cameras(const std::string& by) const {
  std::unique_lock lock(mutex);
  const auto company = followers;
  pass_camera_on(std::move(lock), by);
  for (const auto& weak : company) {
    if (const auto follower = weak.lock()) {
      follower->pass_camera_on(std::unique_lock(follower->mutex), by);
    }
  }
}

std::uint64_t SessionCore::renew_camera_link() {
  const std::lock_guard lock(mutex);
  camera_link = {.number = camera_link.number + 1};
  return camera_link.number;
}

void SessionCore::tell_camera(const std::string& by) {
  viewers.send_all(protocol::make_notification<protocol::notifications::camera_changed>(
                       {.camera = camera_message(), .by = by}),
                   protocol::notifications::camera_changed::name);
}

void SessionCore::tell_camera_of_other_scene(bool before) {
  if (shows_first_view() != before) tell_camera({});
}

RenderState SessionCore::snapshot() const {
  const AnimationClock& clock = timeline.clock();
  RenderState state{.version = version,
                    .rev = rev,
                    .changed_at = changed_at,
                    .resources = resources,
                    .scene = scene,
                    .parts = {.lights = edits.device_lights(),
                              .materials = edits.device_materials(),
                              .layers = edits.device_layers(),
                              .hidden = nodes.hidden_instances()},
                    .edited_members = edits.edited_members(),
                    .selected = nodes.selected_instances(),
                    .section = section.enabled(),
                    .environment = environment,
                    .camera = camera.camera(),
                    .camera_moves = camera.moves(),
                    .discontinuities = camera.discontinuities(),
                    .camera_follows = scene && camera.follows(*scene, clock.clip),
                    .animation = clock,
                    .settings = settings,
                    .width = width,
                    .height = height,
                    .inputs = camera.inputs(),
                    .reset_count = timeline.reset_count(),
                    .lockstep = timeline.lockstep_time(),
                    .reference_started = reference.started()};
  if (shows_first_view()) first_view->replace(state);
  return state;
}

double SessionCore::clip_seconds() const {
  return timeline.clock().at(timeline.lockstep_time().value_or(Clock::now()));
}

Result<void> SessionCore::require_shown_scene() const {
  return shows_first_view() ? Result<void>() : require_scene();
}

Result<void> SessionCore::require_scene_of(const std::optional<std::uint32_t>& asked) const {
  if (!asked || *asked == shown_scene_rev()) return {};
  return protocol::error::conflict("scene_rev", "is that of a scene which is not shown any more");
}

Result<void> SessionCore::require_scene() const {
  if (scene) return {};
  return protocol::error::not_ready("no scene is loaded: scene.load shows one of scene.list");
}

Result<protocol::SettingsApplied> SessionCore::patch_settings(const protocol::RawJson& patch,
                                                              const std::string& by) {
  protocol::Settings patched = settings;
  const Result<nlohmann::json> applied = protocol::apply_patch(patched, patch.value());
  if (!applied) return applied.error();
  if (const auto known = render::check_buffer_name(patched.view.buffer, "view.buffer"); !known) {
    return known.error();
  }
  protocol::RawJson effective(*applied);
  if (patched != settings) {
    const bool first_view_shown = shows_first_view();
    settings = std::move(patched);
    reference.settings_changed(settings);
    changed();
    notify_others<protocol::notifications::settings_changed>(
        by, {.rev = rev, .patch = effective, .by = by});
    tell_camera_of_other_scene(first_view_shown);
  }
  return protocol::SettingsApplied{.rev = rev, .applied = std::move(effective)};
}

}  // namespace heliograph::session
