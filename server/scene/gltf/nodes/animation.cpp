#include "scene/gltf/nodes/animation.hpp"

#include <algorithm>
#include <set>
#include <string>

namespace heliograph::scene {
namespace {

Interpolation read_interpolation(const JsonValue& sampler) {
  const std::string name = sampler.text("interpolation");
  if (name == "STEP") return Interpolation::step;
  if (name == "CUBICSPLINE") return Interpolation::cubic_spline;
  return Interpolation::linear;
}

std::vector<float> read_times(const JsonValue& sampler, const Accessor& input) {
  std::vector<float> times = read_numbers(input);
  if (times.front() < 0.0f) sampler.refuse("input", "starts before 0 seconds");
  const auto unordered = std::ranges::adjacent_find(times, std::ranges::greater_equal());
  if (unordered != times.end()) sampler.refuse("input", "must ascend strictly");
  return times;
}

ElementType element_of(Property property) {
  switch (property) {
    case Property::rotation:
      return ElementType::vec4;
    case Property::weights:
      return ElementType::scalar;
    default:
      return ElementType::vec3;
  }
}

Property to_property(std::string_view path) {
  if (path == "rotation") return Property::rotation;
  if (path == "scale") return Property::scale;
  if (path == "weights") return Property::weights;
  return Property::translation;
}

Channel read_curve(const JsonValue& sampler, std::span<const Accessor> accessors, Channel channel) {
  const Accessor& input = accessors[*sampler.index("input", accessors.size(), "accessors")];
  const Accessor& output = accessors[*sampler.index("output", accessors.size(), "accessors")];
  if (output.element != element_of(channel.property)) {
    sampler.refuse("output", "has the wrong element type for what it animates");
  }
  const bool whole = output.component != ComponentType::f32;
  const bool may_be_whole =
      channel.property == Property::rotation || channel.property == Property::weights;
  if (whole && !(may_be_whole && output.normalized)) {
    sampler.refuse("output", "has the wrong component type for what it animates");
  }
  channel.interpolation = read_interpolation(sampler);
  channel.times = read_times(sampler, input);
  channel.values = read_numbers(output);
  const std::uint64_t per_key = channel.interpolation == Interpolation::cubic_spline ? 3 : 1;
  if (channel.values.size() != channel.times.size() * per_key * channel.width) {
    sampler.refuse("output", "does not match the number of keys");
  }
  return channel;
}

/// Nullopt for channels that animate nothing in the scene.
std::optional<Channel> read_target(const JsonValue& json, const NodeTable& nodes,
                                   Warnings& warnings) {
  const JsonValue target = *json.object("target");
  const std::string path = target.text("path");
  if (path == "pointer") {
    warnings.add("animations of other properties than those of nodes are left out");
    return std::nullopt;
  }
  const auto document_node = target.index("node", nodes.of_document.size(), "nodes");
  const auto node = document_node ? nodes.of_document[*document_node] : std::nullopt;
  if (!node) return std::nullopt;
  Channel channel;
  channel.node = *node;
  channel.property = to_property(path);
  channel.width = component_count(element_of(channel.property));
  const Node& moved = nodes.nodes[*node];
  if (channel.property == Property::weights) {
    channel.width = static_cast<std::uint32_t>(moved.weights.size());
    if (channel.width == 0) {
      warnings.add(nodes.paths[*node] + " has no morph targets that could be animated");
      return std::nullopt;
    }
  } else if (!moved.transform) {
    warnings.add(nodes.paths[*node] + " has a matrix, which cannot be animated");
    return std::nullopt;
  }
  return channel;
}

Clip read_clip(const JsonValue& json, std::span<const Accessor> accessors, const NodeTable& nodes,
               Warnings& warnings) {
  Clip clip;
  clip.name = json.text("name");
  const std::vector<JsonValue> samplers = json.objects("samplers");
  std::set<std::pair<std::uint32_t, Property>> targets;
  for (const JsonValue& channel_json : json.objects("channels")) {
    auto channel = read_target(channel_json, nodes, warnings);
    if (!channel) continue;
    if (!targets.insert({channel->node, channel->property}).second) {
      channel_json.refuse("target", "is animated twice");
    }
    const auto sampler = channel_json.required_index("sampler", samplers.size(), "samplers");
    clip.channels.push_back(read_curve(samplers[sampler], accessors, std::move(*channel)));
    clip.duration = std::max(clip.duration, clip.channels.back().times.back());
  }
  return clip;
}

/// Channels may share samplers and clips may share accessors, so that the file's size is no limit:
/// charges all of them before the first is read.
void pay_for_keys(const JsonValue& animation, std::span<const Accessor> accessors,
                  ByteBudget& budget) {
  const std::vector<JsonValue> samplers = animation.objects("samplers");
  for (const JsonValue& channel : animation.objects("channels")) {
    const JsonValue& sampler =
        samplers[channel.required_index("sampler", samplers.size(), "samplers")];
    for (const char* const end : {"input", "output"}) {
      const Accessor& keys = accessors[*sampler.index(end, accessors.size(), "accessors")];
      budget.take(keys.count, component_count(keys.element) * sizeof(float), sampler.path());
    }
  }
}

std::vector<glm::mat4> read_inverse_binds(const JsonValue& skin,
                                          std::span<const Accessor> accessors, std::size_t joints) {
  const auto index = skin.index("inverseBindMatrices", accessors.size(), "accessors");
  if (!index) return std::vector<glm::mat4>(joints, glm::mat4(1.0f));
  return read_matrices(accessors[*index], joints);
}

}  // namespace

std::vector<Clip> read_clips(const JsonValue& root, std::span<const Accessor> accessors,
                             const NodeTable& nodes, ByteBudget& budget, Warnings& warnings) {
  std::vector<Clip> clips;
  std::set<std::string> names;
  const std::vector<JsonValue> animations = root.objects("animations");
  for (const JsonValue& json : animations) pay_for_keys(json, accessors, budget);
  for (const JsonValue& json : animations) {
    Clip clip = read_clip(json, accessors, nodes, warnings);
    if (clip.channels.empty()) continue;
    if (clip.name.empty()) clip.name = "clip " + std::to_string(clips.size() + 1);
    const std::string requested = clip.name;
    for (int number = 2; !names.insert(clip.name).second; ++number) {
      clip.name = requested + " " + std::to_string(number);
    }
    clips.push_back(std::move(clip));
  }
  return clips;
}

std::vector<Skin> read_skins(const JsonValue& root, std::span<const Accessor> accessors,
                             const NodeTable& nodes, ByteBudget& budget) {
  std::vector<Skin> skins;
  for (const JsonValue& json : root.objects("skins")) {
    Skin& skin = skins.emplace_back();
    const auto joints = json.indices("joints", nodes.of_document.size(), "nodes");
    budget.take(joints.size(), sizeof(glm::mat4), json.path());
    for (const std::uint32_t joint : joints) {
      if (nodes.of_document[joint]) skin.joints.push_back(*nodes.of_document[joint]);
    }
    if (skin.joints.size() < joints.size()) skin.joints.clear();
    skin.inverse_bind = read_inverse_binds(json, accessors, skin.joints.size());
  }
  return skins;
}

}  // namespace heliograph::scene
