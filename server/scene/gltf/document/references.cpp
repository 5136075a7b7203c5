#include "scene/gltf/document/references.hpp"

#include "scene/gltf/document/extension_value.hpp"

namespace heliograph::scene {
namespace {

void check_sampler(const tinygltf::AnimationSampler& sampler, const std::string& place,
                   std::span<const Accessor> accessors) {
  const Accessor& input = accessors[static_cast<std::size_t>(sampler.input)];
  const Accessor& output = accessors[static_cast<std::size_t>(sampler.output)];
  if (input.element != ElementType::scalar || input.component != ComponentType::f32) {
    refuse_at(place, "input", "must contain float scalars");
  }
  const std::uint32_t values_per_key = sampler.interpolation == "CUBICSPLINE" ? 3 : 1;
  if (output.count % (std::uint64_t(input.count) * values_per_key) != 0) {
    refuse_at(place, "output", "does not match the number of keys");
  }
}

}  // namespace

void check_skins(const tinygltf::Model& model, std::span<const Accessor> accessors) {
  for (std::size_t i = 0; i < model.skins.size(); ++i) {
    const tinygltf::Skin& skin = model.skins[i];
    const auto matrices = to_index(skin.inverseBindMatrices);
    if (!matrices) continue;
    const Accessor& accessor = accessors[*matrices];
    if (accessor.element != ElementType::mat4 || accessor.component != ComponentType::f32) {
      refuse_at(item_path("", "skins", i), "inverseBindMatrices",
                "must contain float 4x4 matrices");
    }
    if (accessor.count < skin.joints.size()) {
      refuse_at(item_path("", "skins", i), "inverseBindMatrices",
                "has fewer matrices than there are joints");
    }
  }
}

void check_animations(const tinygltf::Model& model, std::span<const Accessor> accessors) {
  for (std::size_t i = 0; i < model.animations.size(); ++i) {
    const auto& samplers = model.animations[i].samplers;
    for (std::size_t k = 0; k < samplers.size(); ++k) {
      check_sampler(samplers[k], item_path(item_path("", "animations", i), "samplers", k),
                    accessors);
    }
  }
}

}  // namespace heliograph::scene
