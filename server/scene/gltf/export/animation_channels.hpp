#pragma once

#include <cstddef>
#include <set>
#include <span>
#include <string_view>

#include "scene/gltf/export/editable_document.hpp"

// Channels of animations, where edits concern what they animate.

namespace heliograph::scene {

/// Nodes that animations move, by "node" or by pointers (KHR_animation_pointer).
std::set<std::size_t> find_animated_nodes(EditableDocument& document);

/// Has a light of KHR_lights_punctual animated as another one is, with the same samplers, but for
/// `edited` members. These are named as pointers name them below their light.
void copy_light_channels(EditableDocument& document, std::size_t from, std::size_t to,
                         std::span<const std::string_view> edited);
/// Ends the animation of `edited` members of a light. Animations without other channels go.
void erase_light_channels(EditableDocument& document, std::size_t light,
                          std::span<const std::string_view> edited);

}  // namespace heliograph::scene
