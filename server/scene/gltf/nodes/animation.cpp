#include "scene/gltf/nodes/animation.hpp"

#include <algorithm>
#include <set>
#include <string>

#include "scene/gltf/document/extension_value.hpp"

namespace heliograph::scene {
namespace {

Interpolation to_interpolation(const std::string& name) {
  if (name == "STEP") return Interpolation::step;
  if (name == "CUBICSPLINE") return Interpolation::cubic_spline;
  return Interpolation::linear;
}

/// A sampler of an animation, and how errors name it.
struct SamplerSource {
  const tinygltf::AnimationSampler& sampler;
  std::string path;

  const Accessor& input(std::span<const Accessor> accessors) const {
    return accessors[static_cast<std::size_t>(sampler.input)];
  }
  const Accessor& output(std::span<const Accessor> accessors) const {
    return accessors[static_cast<std::size_t>(sampler.output)];
  }
  [[noreturn]] void refuse(std::string_view member, std::string_view reason) const {
    refuse_at(path, member, reason);
  }
};

SamplerSource sampler_of(const tinygltf::Animation& animation, const std::string& path,
                         const tinygltf::AnimationChannel& channel) {
  const auto index = static_cast<std::size_t>(channel.sampler);
  return {animation.samplers[index], item_path(path, "samplers", index)};
}

std::vector<float> read_times(const SamplerSource& source, const Accessor& input) {
  std::vector<float> times = read_numbers(input);
  if (times.front() < 0.0f) source.refuse("input", "starts before 0 seconds");
  if (!std::ranges::is_sorted(times)) source.refuse("input", "must ascend");
  return times;
}

/// Drops keys at the same time as the one before.
void drop_repeated_keys(Channel& channel, std::size_t numbers_per_key, const SamplerSource& source,
                        Warnings& warnings) {
  if (std::ranges::adjacent_find(channel.times) == channel.times.end()) return;
  std::size_t kept = 1;
  for (std::size_t i = 1; i < channel.times.size(); ++i) {
    if (channel.times[i] == channel.times[kept - 1]) continue;
    channel.times[kept] = channel.times[i];
    std::copy_n(channel.values.begin() + std::ptrdiff_t(i * numbers_per_key), numbers_per_key,
                channel.values.begin() + std::ptrdiff_t(kept * numbers_per_key));
    ++kept;
  }
  warnings.add(source.path + ".input repeats times: of such keys only the first is used");
  channel.times.resize(kept);
  channel.values.resize(kept * numbers_per_key);
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

Channel read_curve(const SamplerSource& sampler, std::span<const Accessor> accessors,
                   Channel channel, Warnings& warnings) {
  const Accessor& input = sampler.input(accessors);
  const Accessor& output = sampler.output(accessors);
  if (output.element != element_of(channel.property)) {
    sampler.refuse("output", "has the wrong element type for what it animates");
  }
  const bool whole = output.component != ComponentType::f32;
  const bool may_be_whole =
      channel.property == Property::rotation || channel.property == Property::weights;
  if (whole && !(may_be_whole && output.normalized)) {
    sampler.refuse("output", "has the wrong component type for what it animates");
  }
  channel.interpolation = to_interpolation(sampler.sampler.interpolation);
  channel.times = read_times(sampler, input);
  channel.values = read_numbers(output);
  const std::uint64_t per_key = channel.interpolation == Interpolation::cubic_spline ? 3 : 1;
  if (channel.values.size() != channel.times.size() * per_key * channel.width) {
    sampler.refuse("output", "does not match the number of keys");
  }
  drop_repeated_keys(channel, per_key * channel.width, sampler, warnings);
  return channel;
}

/// Nullopt for channels that animate nothing in the scene.
std::optional<Channel> read_target(const tinygltf::AnimationChannel& document,
                                   const NodeTable& nodes, Warnings& warnings) {
  if (document.target_path == "pointer") {
    warnings.add("animations of other properties than those of nodes are left out");
    return std::nullopt;
  }
  const auto document_node = to_index(document.target_node);
  const auto node = document_node ? nodes.of_document[*document_node] : std::nullopt;
  if (!node) return std::nullopt;
  Channel channel;
  channel.node = *node;
  channel.property = to_property(document.target_path);
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

Clip read_clip(const tinygltf::Animation& animation, const std::string& path,
               std::span<const Accessor> accessors, const NodeTable& nodes, Warnings& warnings) {
  Clip clip;
  clip.name = animation.name;
  std::set<std::pair<std::uint32_t, Property>> targets;
  for (std::size_t i = 0; i < animation.channels.size(); ++i) {
    auto channel = read_target(animation.channels[i], nodes, warnings);
    if (!channel) continue;
    if (!targets.insert({channel->node, channel->property}).second) {
      refuse_at(item_path(path, "channels", i), "target", "is animated twice");
    }
    clip.channels.push_back(read_curve(sampler_of(animation, path, animation.channels[i]),
                                       accessors, std::move(*channel), warnings));
    clip.duration = std::max(clip.duration, clip.channels.back().times.back());
  }
  return clip;
}

/// Channels may share samplers and clips may share accessors, so that the file's size is no limit:
/// charges all of them before the first is read.
void pay_for_keys(const tinygltf::Animation& animation, const std::string& path,
                  std::span<const Accessor> accessors, ByteBudget& budget) {
  for (const tinygltf::AnimationChannel& channel : animation.channels) {
    const SamplerSource sampler = sampler_of(animation, path, channel);
    for (const Accessor* keys : {&sampler.input(accessors), &sampler.output(accessors)}) {
      budget.take(keys->count, component_count(keys->element) * sizeof(float), sampler.path);
    }
  }
}

}  // namespace

std::vector<Clip> read_clips(const tinygltf::Model& model, std::span<const Accessor> accessors,
                             const NodeTable& nodes, ByteBudget& budget, Warnings& warnings) {
  std::vector<Clip> clips;
  std::set<std::string> names;
  const auto path = [](std::size_t i) { return item_path("", "animations", i); };
  for (std::size_t i = 0; i < model.animations.size(); ++i) {
    pay_for_keys(model.animations[i], path(i), accessors, budget);
  }
  for (std::size_t i = 0; i < model.animations.size(); ++i) {
    Clip clip = read_clip(model.animations[i], path(i), accessors, nodes, warnings);
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

std::vector<Skin> read_skins(const tinygltf::Model& model, std::span<const Accessor> accessors,
                             const NodeTable& nodes, ByteBudget& budget) {
  std::vector<Skin> skins;
  for (const tinygltf::Skin& document : model.skins) {
    budget.take(document.joints.size(), sizeof(glm::mat4), item_path("", "skins", skins.size()));
    Skin& skin = skins.emplace_back();
    for (const int joint : document.joints) {
      const auto node = nodes.of_document[static_cast<std::size_t>(joint)];
      if (node) skin.joints.push_back(*node);
    }
    if (skin.joints.size() < document.joints.size()) skin.joints.clear();
    const auto matrices = to_index(document.inverseBindMatrices);
    skin.inverse_bind = matrices ? read_matrices(accessors[*matrices], skin.joints.size())
                                 : std::vector<glm::mat4>(skin.joints.size(), glm::mat4(1.0f));
  }
  return skins;
}

}  // namespace heliograph::scene
