#include "scene/animation/pose.hpp"

#include <algorithm>
#include <cmath>

#include "scene/animation/tracks.hpp"
#include "scene/gltf/nodes/cameras.hpp"

namespace heliograph::scene {
namespace {

/// The two keys around a time, and the interpolation parameter between them.
struct Span {
  std::size_t first;
  std::size_t second;
  float fraction;
  float seconds;  // from key to key
};

Span span_at(const std::vector<float>& times, float seconds) {
  const auto after = std::upper_bound(times.begin(), times.end(), seconds);
  if (after == times.begin()) return {0, 0, 0.0f, 0.0f};
  const auto second = static_cast<std::size_t>(after - times.begin());
  if (after == times.end()) return {second - 1, second - 1, 0.0f, 0.0f};
  const float length = times[second] - times[second - 1];
  return {second - 1, second, (seconds - times[second - 1]) / length, length};
}

glm::quat to_quaternion(const float* xyzw) {
  return {xyzw[3], xyzw[0], xyzw[1], xyzw[2]};
}

void store(const glm::quat& rotation, float* xyzw) {
  const float length = glm::length(rotation);
  const glm::quat unit = length > 0.0f ? rotation / length : glm::quat(1.0f, 0.0f, 0.0f, 0.0f);
  xyzw[0] = unit.x;
  xyzw[1] = unit.y;
  xyzw[2] = unit.z;
  xyzw[3] = unit.w;
}

/// Spherical interpolation along the shorter arc; linear where the rotations hardly differ.
glm::quat spherical(const glm::quat& from, glm::quat to, float fraction) {
  float cosine = glm::dot(from, to);
  if (cosine < 0.0f) {
    to = -to;
    cosine = -cosine;
  }
  if (cosine > 0.9995f) return from * (1.0f - fraction) + to * fraction;
  const float angle = std::acos(cosine);
  return (from * std::sin((1.0f - fraction) * angle) + to * std::sin(fraction * angle)) /
         std::sin(angle);
}

/// A cubic Hermite spline whose tangents are per second (glTF 2.0, C.5).
void sample_spline(const Curve& curve, const Span& span, float* value) {
  const std::size_t width = curve.width;
  const float* first = &curve.values[3 * width * span.first];
  const float* second = &curve.values[3 * width * span.second];
  const float t = span.fraction, t2 = t * t, t3 = t2 * t;
  for (std::size_t i = 0; i < width; ++i) {
    const float start = first[width + i], out_tangent = span.seconds * first[2 * width + i];
    const float in_tangent = span.seconds * second[i], end = second[width + i];
    value[i] = (2.0f * t3 - 3.0f * t2 + 1.0f) * start + (t3 - 2.0f * t2 + t) * out_tangent +
               (-2.0f * t3 + 3.0f * t2) * end + (t3 - t2) * in_tangent;
  }
}

void apply(const Channel& channel, const float* value, Transform& transform) {
  switch (channel.property) {
    case Property::translation:
      transform.translation = {value[0], value[1], value[2]};
      break;
    case Property::rotation:
      transform.rotation = to_quaternion(value);
      break;
    case Property::scale:
      transform.scale = {value[0], value[1], value[2]};
      break;
    case Property::weights:
      break;
  }
}

}  // namespace

Pose rest_pose(const Scene& scene) {
  Pose pose;
  for (const Node& node : scene.nodes) {
    pose.worlds.push_back(node.world);
    pose.weights.push_back(node.weights);
  }
  return pose;
}

const Clip* find_clip(const Scene& scene, std::string_view name) {
  const auto found = std::ranges::find(scene.clips, name, &Clip::name);
  return found == scene.clips.end() ? nullptr : &*found;
}

float moment_of(const Clip& clip, double seconds) {
  if (!(seconds > 0.0) || clip.duration <= 0.0f) return 0.0f;
  if (seconds <= clip.duration) return static_cast<float>(seconds);
  return static_cast<float>(std::fmod(seconds, static_cast<double>(clip.duration)));
}

Pose pose_at(const Scene& scene, const Clip* clip, double seconds) {
  Pose pose = rest_pose(scene);
  if (clip) evaluate(scene, *clip, seconds, pose);
  return pose;
}

Camera camera_at(const Scene& scene, const Camera& camera, const Clip* clip, double seconds) {
  if (!camera.node) return camera;
  const Pose pose = pose_at(scene, clip, seconds);
  return place_camera(clip ? with_lens(camera, *clip, seconds) : camera, camera.name,
                      pose.worlds[*camera.node], scene.bounds);
}

std::vector<bool> movable_nodes(const Scene& scene) {
  std::vector<bool> movable(scene.nodes.size());
  for (const Clip& clip : scene.clips) {
    for (const Channel& channel : clip.channels) {
      if (channel.property != Property::weights) movable[channel.node] = true;
    }
  }
  for (std::size_t i = 0; i < movable.size(); ++i) {
    const auto parent = scene.nodes[i].parent;
    if (parent && movable[*parent]) movable[i] = true;
  }
  return movable;
}

bool carries(const Scene& scene, const Clip& clip, const Camera& camera) {
  if (changes_lens(clip, camera)) return true;
  for (auto node = camera.node; node; node = scene.nodes[*node].parent) {
    for (const Channel& channel : clip.channels) {
      if (channel.node == *node && channel.property != Property::weights) return true;
    }
  }
  return false;
}

void sample(const Curve& curve, float seconds, float* value) {
  const Span span = span_at(curve.times, seconds);
  if (curve.interpolation == Interpolation::cubic_spline) return sample_spline(curve, span, value);
  const float* first = &curve.values[curve.width * span.first];
  const float* second = &curve.values[curve.width * span.second];
  const float fraction = curve.interpolation == Interpolation::step ? 0.0f : span.fraction;
  for (std::size_t i = 0; i < curve.width; ++i) {
    value[i] = first[i] + (second[i] - first[i]) * fraction;
  }
}

void sample(const Channel& channel, float seconds, float* value) {
  const Curve& curve = channel;
  const bool rotation = channel.property == Property::rotation;
  if (!rotation || channel.interpolation != Interpolation::linear) {
    sample(curve, seconds, value);
    if (rotation) store(to_quaternion(value), value);
    return;
  }
  const Span span = span_at(curve.times, seconds);
  store(spherical(to_quaternion(&curve.values[4 * span.first]),
                  to_quaternion(&curve.values[4 * span.second]), span.fraction),
        value);
}

void evaluate(const Scene& scene, const Clip& clip, double seconds, Pose& pose) {
  const float moment = moment_of(clip, seconds);
  std::vector<std::optional<Transform>> moved(scene.nodes.size());
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) pose.weights[i] = scene.nodes[i].weights;
  for (const Channel& channel : clip.channels) {
    if (channel.property == Property::weights) {
      sample(channel, moment, pose.weights[channel.node].data());
      continue;
    }
    auto& transform = moved[channel.node];
    if (!transform) transform = scene.nodes[channel.node].transform.value_or(Transform{});
    float value[4];
    sample(channel, moment, value);
    apply(channel, value, *transform);
  }
  std::vector<bool> differs(scene.nodes.size());
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    const Node& node = scene.nodes[i];
    differs[i] = moved[i] || (node.parent && differs[*node.parent]);
    if (!differs[i]) {
      pose.worlds[i] = node.world;
      continue;
    }
    const glm::mat4 local = moved[i] ? moved[i]->matrix() : node.local;
    pose.worlds[i] = node.parent ? pose.worlds[*node.parent] * local : local;
  }
}

}  // namespace heliograph::scene
