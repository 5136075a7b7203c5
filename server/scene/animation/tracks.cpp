#include "scene/animation/tracks.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

#include "scene/animation/pose.hpp"

namespace heliograph::scene {
namespace {

struct Range {
  float least;
  float most;
};

constexpr float no_limit = std::numeric_limits<float>::max();
constexpr float quarter_turn = std::numbers::pi_v<float> / 2.0f;

/// What a file may have, and what the renderer is made for: splines leave it between their keys.
Range range_of(PointedProperty property) {
  switch (property) {
    case PointedProperty::texture_offset:
    case PointedProperty::texture_rotation:
    case PointedProperty::texture_scale:
    case PointedProperty::anisotropy_rotation:
      return {-no_limit, no_limit};
    case PointedProperty::light_intensity:
      return {0.0f, 1e12f};
    case PointedProperty::light_color:
    case PointedProperty::emissive:
    case PointedProperty::emissive_strength:
    case PointedProperty::thickness:
      return {0.0f, 1e6f};
    // 0 would be infinite for the device.
    case PointedProperty::light_range:
    case PointedProperty::attenuation_distance:
      return {1e-6f, 1e6f};
    case PointedProperty::inner_cone:
    case PointedProperty::outer_cone:
      return {0.0f, quarter_turn};
    case PointedProperty::vertical_fov:
      return {1e-3f, 179.0f / 90.0f * quarter_turn};
    case PointedProperty::orthographic_height:
      return {-0.25f * no_limit, 0.25f * no_limit};  // its absolute value is shown, twice
    case PointedProperty::normal_scale:
    case PointedProperty::clearcoat_normal_scale:
      return {-16.0f, 16.0f};
    case PointedProperty::ior:
      return {0.0f, 10.0f};
    case PointedProperty::iridescence_ior:
      return {1.0f, 10.0f};
    case PointedProperty::specular_color:
      return {0.0f, 1000.0f};
    case PointedProperty::iridescence_thickness_minimum:
    case PointedProperty::iridescence_thickness_maximum:
      return {0.0f, 1e5f};
    case PointedProperty::dispersion:
      return {0.0f, 20.0f};
    default:
      return {0.0f, 1.0f};
  }
}

bool is_of_lens(PointedProperty property) {
  return property == PointedProperty::vertical_fov ||
         property == PointedProperty::orthographic_height;
}

bool is_lens_of(const Track& track, const Camera& camera) {
  return camera.node && track.object == camera.number && is_of_lens(track.property);
}

}  // namespace

bool has_tracks(const Scene& scene) {
  return std::ranges::any_of(scene.clips, [](const Clip& clip) { return !clip.tracks.empty(); });
}

std::array<float, 4> value_of(const Track& track, float moment) {
  std::array<float, 4> value{};
  sample(track, moment, value.data());
  const auto [least, most] = range_of(track.property);
  // The first comparison is false for what is no number.
  for (float& number : value) number = number >= least ? std::min(number, most) : least;
  // A dielectric's index is 1 or more; 0 stands for a surface that reflects all light.
  if (track.property == PointedProperty::ior && value[0] > 0.0f) {
    value[0] = std::max(value[0], 1.0f);
  }
  return value;
}

std::vector<bool> shown_nodes(const Scene& scene, const Clip* clip, double seconds) {
  std::vector<bool> shown;
  for (const Node& node : scene.nodes) shown.push_back(node.visible);
  if (clip) {
    const float moment = moment_of(*clip, seconds);
    for (const Track& track : clip->tracks) {
      if (track.property != PointedProperty::visible) continue;
      shown[track.object] = value_of(track, moment)[0] != 0.0f;
    }
  }
  if (std::ranges::find(shown, false) == shown.end()) return {};
  // Parents come first.
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const auto parent = scene.nodes[i].parent;
    if (parent && !shown[*parent]) shown[i] = false;
  }
  return shown;
}

bool switches_nodes(const Clip& clip) {
  return std::ranges::find(clip.tracks, PointedProperty::visible, &Track::property) !=
         clip.tracks.end();
}

bool changes_lens(const Clip& clip, const Camera& camera) {
  return std::ranges::any_of(clip.tracks,
                             [&](const Track& track) { return is_lens_of(track, camera); });
}

Camera with_lens(Camera camera, const Clip& clip, double seconds) {
  const float moment = moment_of(clip, seconds);
  for (const Track& track : clip.tracks) {
    if (!is_lens_of(track, camera)) continue;
    const float value = value_of(track, moment)[0];
    if (track.property == PointedProperty::vertical_fov) {
      camera.vertical_fov = glm::degrees(value);
    } else {
      camera.orthographic_height = std::max(2.0f * std::abs(value), 1e-6f);
    }
  }
  return camera;
}

}  // namespace heliograph::scene
