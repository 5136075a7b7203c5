#include "scene/gltf/nodes/animation.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <tuple>

#include "scene/gltf/document/extension_value.hpp"
#include "scene/gltf/nodes/animation_pointer.hpp"
#include "scene/quote.hpp"

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
void drop_repeated_keys(Curve& curve, std::size_t numbers_per_key, const SamplerSource& source,
                        Warnings& warnings) {
  if (std::ranges::adjacent_find(curve.times) == curve.times.end()) return;
  std::size_t kept = 1;
  for (std::size_t i = 1; i < curve.times.size(); ++i) {
    if (curve.times[i] == curve.times[kept - 1]) continue;
    curve.times[kept] = curve.times[i];
    std::copy_n(curve.values.begin() + std::ptrdiff_t(i * numbers_per_key), numbers_per_key,
                curve.values.begin() + std::ptrdiff_t(kept * numbers_per_key));
    ++kept;
  }
  warnings.add(source.path + ".input repeats times: of such keys only the first is used");
  curve.times.resize(kept);
  curve.values.resize(kept * numbers_per_key);
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

ElementType element_of(PointedProperty property) {
  switch (property) {
    case PointedProperty::base_color:
      return ElementType::vec4;
    case PointedProperty::light_color:
    case PointedProperty::emissive:
    case PointedProperty::specular_color:
    case PointedProperty::sheen_color:
    case PointedProperty::attenuation_color:
    case PointedProperty::diffuse_transmission_color:
      return ElementType::vec3;
    case PointedProperty::texture_offset:
    case PointedProperty::texture_scale:
      return ElementType::vec2;
    default:
      return ElementType::scalar;
  }
}

Property to_property(std::string_view path) {
  if (path == "rotation") return Property::rotation;
  if (path == "scale") return Property::scale;
  if (path == "weights") return Property::weights;
  return Property::translation;
}

/// What an output may consist of.
enum class Components {
  floats,
  floats_or_normalized,  // integers
  any,                   // others than floats are converted
  truth,                 // unsigned bytes, 0 for false, that do not blend
};

void check_output(const SamplerSource& sampler, const Accessor& output, ElementType element,
                  Components components) {
  if (output.element != element) {
    sampler.refuse("output", "has the wrong element type for what it animates");
  }
  const bool whole = output.component != ComponentType::f32;
  bool fits = !whole || components == Components::any;
  if (components == Components::truth) fits = output.component == ComponentType::u8;
  if (components == Components::floats_or_normalized) fits |= output.normalized;
  if (!fits) sampler.refuse("output", "has the wrong component type for what it animates");
  if (components == Components::truth && sampler.sampler.interpolation != "STEP") {
    sampler.refuse("interpolation", "must be STEP for what it animates");
  }
}

/// Into a curve that has its width.
void read_curve(const SamplerSource& sampler, std::span<const Accessor> accessors, Curve& curve,
                Warnings& warnings) {
  curve.interpolation = to_interpolation(sampler.sampler.interpolation);
  curve.times = read_times(sampler, sampler.input(accessors));
  curve.values = read_numbers(sampler.output(accessors));
  const std::uint64_t per_key = curve.interpolation == Interpolation::cubic_spline ? 3 : 1;
  if (curve.values.size() != curve.times.size() * per_key * curve.width) {
    sampler.refuse("output", "does not match the number of keys");
  }
  drop_repeated_keys(curve, per_key * curve.width, sampler, warnings);
}

/// Reads one animation after the other.
class ClipReader {
 public:
  ClipReader(const tinygltf::Model& model, std::span<const Accessor> accessors,
             const NodeTable& nodes, Warnings& warnings)
      : model_(model),
        accessors_(accessors),
        nodes_(nodes),
        warnings_(warnings),
        requires_pointers_(std::ranges::find(model.extensionsRequired, "KHR_animation_pointer") !=
                           model.extensionsRequired.end()) {}

  Clip read(const tinygltf::Animation& animation, const std::string& path) {
    clip_ = {};
    clip_.name = animation.name;
    targets_.clear();
    for (std::size_t i = 0; i < animation.channels.size(); ++i) {
      const tinygltf::AnimationChannel& channel = animation.channels[i];
      const std::string channel_path = item_path(path, "channels", i);
      const SamplerSource sampler = sampler_of(animation, path, channel);
      if (has_pointer(channel)) {
        read_pointer(channel, sampler, channel_path);
      } else {
        read_channel(to_property(channel.target_path), to_index(channel.target_node), sampler,
                     channel_path, false);
      }
    }
    return std::move(clip_);
  }

  std::vector<AnimatedSlot> take_slots() { return std::move(slots_); }

 private:
  void read_pointer(const tinygltf::AnimationChannel& channel, const SamplerSource& sampler,
                    const std::string& path) {
    const std::optional<PointedTarget> target = resolve_pointer(channel, model_, path);
    if (!target) return leave_out(pointer_of(channel));
    if (const auto* const property = std::get_if<Property>(&target->property)) {
      read_channel(*property, target->object, sampler, path, true);
    } else {
      read_track(*target, sampler, path, pointer_of(channel));
    }
  }

  void leave_out(const std::string& pointer) {
    if (requires_pointers_) {
      throw ImportError(
          "requires extensions that are not supported: \"KHR_animation_pointer\" to " +
          in_quotes(pointer));
    }
    warnings_.add("the animation of " + in_quotes(pointer) + " is left out");
  }

  /// Channels that animate nothing in the scene are left out.
  void read_channel(Property property, std::optional<std::uint32_t> document_node,
                    const SamplerSource& sampler, const std::string& path, bool pointed) {
    const auto node = document_node ? nodes_.of_document[*document_node] : std::nullopt;
    if (!node) return;
    Channel channel;
    channel.node = *node;
    channel.property = property;
    channel.width = component_count(element_of(property));
    const Node& moved = nodes_.nodes[*node];
    if (property == Property::weights) {
      channel.width = static_cast<std::uint32_t>(moved.weights.size());
      if (channel.width == 0) {
        return warnings_.add(nodes_.paths[*node] + " has no morph targets that could be animated");
      }
    } else if (!moved.transform) {
      return warnings_.add(nodes_.paths[*node] + " has a matrix, which cannot be animated");
    }
    claim({false, static_cast<int>(property), *node, 0}, path);
    const bool blends = property == Property::rotation || property == Property::weights;
    check_output(sampler, sampler.output(accessors_), element_of(property),
                 pointed  ? Components::any
                 : blends ? Components::floats_or_normalized
                          : Components::floats);
    read_curve(sampler, accessors_, channel, warnings_);
    clip_.duration = std::max(clip_.duration, channel.times.back());
    clip_.channels.push_back(std::move(channel));
  }

  void read_track(const PointedTarget& target, const SamplerSource& sampler,
                  const std::string& path, const std::string& pointer) {
    Track track;
    track.property = std::get<PointedProperty>(target.property);
    track.object = target.object;
    track.width = component_count(element_of(track.property));
    const bool visibility = track.property == PointedProperty::visible;
    if (visibility) {
      if (!nodes_.of_document[target.object]) return;
      track.object = *nodes_.of_document[target.object];
    }
    claim({true, static_cast<int>(track.property), track.object, target.kind}, path);
    check_output(sampler, sampler.output(accessors_), element_of(track.property),
                 visibility ? Components::truth : Components::any);
    read_curve(sampler, accessors_, track, warnings_);
    if (track.property == PointedProperty::base_color) warn_of_alpha(track, pointer);
    if (is_of_texture(track.property)) track.object = slot_of(target);
    clip_.duration = std::max(clip_.duration, track.times.back());
    clip_.tracks.push_back(std::move(track));
  }

  /// Whether it is a pointer, its property, its object, and which of its slots.
  using Claim = std::tuple<bool, int, std::uint32_t, std::uint32_t>;
  void claim(const Claim& target, const std::string& path) {
    if (!targets_.insert(target).second) refuse_at(path, "target", "is animated twice");
  }

  static bool is_of_texture(PointedProperty property) {
    return property == PointedProperty::texture_offset ||
           property == PointedProperty::texture_rotation ||
           property == PointedProperty::texture_scale;
  }

  /// Rays and draws go by the alpha of the file.
  void warn_of_alpha(const Track& track, const std::string& pointer) {
    const tinygltf::Material& material = model_.materials[track.object];
    if (material.alphaMode != "BLEND" && material.alphaMode != "MASK") return;
    const bool spline = track.interpolation == Interpolation::cubic_spline;
    const std::size_t first = spline ? 7 : 3, step = spline ? 12 : 4;
    const auto alpha = static_cast<float>(material.pbrMetallicRoughness.baseColorFactor[3]);
    for (std::size_t i = first; i < track.values.size(); i += step) {
      if (track.values[i] == alpha) continue;
      return warnings_.add("the animation of " + in_quotes(pointer) + " leaves alpha as it is");
    }
  }

  std::uint32_t slot_of(const PointedTarget& target) {
    const auto next = static_cast<std::uint32_t>(slots_.size());
    const auto [known, is_new] = slot_numbers_.try_emplace({target.object, target.kind}, next);
    if (is_new) {
      slots_.push_back({.material = target.object,
                        .kind = target.kind,
                        .transform = file_transform(model_.materials[target.object], target.kind)});
    }
    return known->second;
  }

  const tinygltf::Model& model_;
  std::span<const Accessor> accessors_;
  const NodeTable& nodes_;
  Warnings& warnings_;
  const bool requires_pointers_;
  std::vector<AnimatedSlot> slots_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> slot_numbers_;
  Clip clip_;                // that is being read
  std::set<Claim> targets_;  // of its channels
};

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

Animations read_animations(const tinygltf::Model& model, std::span<const Accessor> accessors,
                           const NodeTable& nodes, ByteBudget& budget, Warnings& warnings) {
  Animations read;
  std::set<std::string> names;
  const auto path = [](std::size_t i) { return item_path("", "animations", i); };
  for (std::size_t i = 0; i < model.animations.size(); ++i) {
    pay_for_keys(model.animations[i], path(i), accessors, budget);
  }
  ClipReader reader(model, accessors, nodes, warnings);
  for (std::size_t i = 0; i < model.animations.size(); ++i) {
    Clip clip = reader.read(model.animations[i], path(i));
    if (clip.channels.empty() && clip.tracks.empty()) continue;
    if (clip.name.empty()) clip.name = "clip " + std::to_string(read.clips.size() + 1);
    const std::string requested = clip.name;
    for (int number = 2; !names.insert(clip.name).second; ++number) {
      clip.name = requested + " " + std::to_string(number);
    }
    read.clips.push_back(std::move(clip));
  }
  read.slots = reader.take_slots();
  return read;
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
