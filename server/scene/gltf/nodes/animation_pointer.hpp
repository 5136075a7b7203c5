#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "scene/scene.hpp"

namespace heliograph::scene {

/// The property that a pointer of KHR_animation_pointer names.
struct PointedTarget {
  /// Of a node what other animations have, too; or another property.
  std::variant<Property, PointedProperty> property;
  std::uint32_t object = 0;  // number in the document: of a node, material, light or camera
  std::uint32_t kind = 0;    // of a texture transform: in texture_kinds()
};

/// Whether the channel animates what a pointer names.
bool has_pointer(const tinygltf::AnimationChannel& channel);
/// That of such a channel (JSON pointer, RFC 6901).
std::string pointer_of(const tinygltf::AnimationChannel& channel);

/// What the pointer of a channel names; nullopt where that cannot be animated. `path`: of the
/// channel, for errors.
/// @throws ImportError where it is no JSON pointer, or the document has no such object
std::optional<PointedTarget> resolve_pointer(const tinygltf::AnimationChannel& channel,
                                             const tinygltf::Model& model, const std::string& path);

/// The file's transform in a texture slot of a material; `kind`: in texture_kinds().
TextureTransform file_transform(const tinygltf::Material& material, std::uint32_t kind);

/// By node of the document: whether an animation changes its visibility.
/// @throws ImportError
std::vector<bool> nodes_that_blink(const tinygltf::Model& model);

}  // namespace heliograph::scene
