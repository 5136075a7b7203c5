#include "scene/gltf/document/references.hpp"

#include <algorithm>

namespace heliograph::scene {
namespace {

void check_sampler(const JsonValue& sampler, std::span<const Accessor> accessors) {
  const Accessor& input = accessors[sampler.required_index("input", accessors.size(), "accessors")];
  const Accessor& output =
      accessors[sampler.required_index("output", accessors.size(), "accessors")];
  if (input.element != ElementType::scalar || input.component != ComponentType::f32) {
    sampler.refuse("input", "must contain float scalars");
  }
  const std::string interpolation = sampler.text("interpolation");
  if (!interpolation.empty() && interpolation != "LINEAR" && interpolation != "STEP" &&
      interpolation != "CUBICSPLINE") {
    sampler.refuse("interpolation", "is not LINEAR, STEP or CUBICSPLINE");
  }
  const std::uint32_t values_per_key = interpolation == "CUBICSPLINE" ? 3 : 1;
  if (output.count % (std::uint64_t(input.count) * values_per_key) != 0) {
    sampler.refuse("output", "does not match the number of keys");
  }
}

void check_channel(const JsonValue& channel, std::size_t sampler_count, std::size_t node_count) {
  static constexpr std::array<std::string_view, 5> paths = {"translation", "rotation", "scale",
                                                            "weights", "pointer"};
  channel.required_index("sampler", sampler_count, "samplers");
  const auto target = channel.object("target");
  if (!target) channel.refuse("target", "is missing");
  target->index("node", node_count, "nodes");
  if (std::find(paths.begin(), paths.end(), target->text("path")) == paths.end()) {
    target->refuse("path", "is not a property that can be animated");
  }
}

}  // namespace

void check_skins(const JsonValue& root, std::span<const Accessor> accessors) {
  const std::size_t node_count = root.objects("nodes").size();
  for (const JsonValue& skin : root.objects("skins")) {
    const std::vector<std::uint32_t> joints = skin.indices("joints", node_count, "nodes");
    if (joints.empty()) skin.refuse("joints", "must name at least one node");
    skin.index("skeleton", node_count, "nodes");
    const auto matrices = skin.index("inverseBindMatrices", accessors.size(), "accessors");
    if (!matrices) continue;
    const Accessor& accessor = accessors[*matrices];
    if (accessor.element != ElementType::mat4 || accessor.component != ComponentType::f32) {
      skin.refuse("inverseBindMatrices", "must contain float 4x4 matrices");
    }
    if (accessor.count < joints.size())
      skin.refuse("inverseBindMatrices", "has fewer matrices than there are joints");
  }
}

void check_animations(const JsonValue& root, std::span<const Accessor> accessors) {
  const std::size_t node_count = root.objects("nodes").size();
  for (const JsonValue& animation : root.objects("animations")) {
    const std::vector<JsonValue> samplers = animation.objects("samplers");
    const std::vector<JsonValue> channels = animation.objects("channels");
    if (samplers.empty() || channels.empty()) animation.refuse("must have samplers and channels");
    for (const JsonValue& sampler : samplers) check_sampler(sampler, accessors);
    for (const JsonValue& channel : channels) check_channel(channel, samplers.size(), node_count);
  }
}

}  // namespace heliograph::scene
