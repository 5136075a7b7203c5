#pragma once

#include <array>
#include <span>

#include "protocol/messages/edit_messages.hpp"
#include "scene/scene.hpp"

// Members of lights and materials that a clip animates by pointers.

namespace heliograph::session {

/// A value of a track at a moment.
struct TrackValue {
  scene::PointedProperty property{};
  std::array<float, 4> numbers{};
  bool operator==(const TrackValue&) const = default;
};

/// A light of the scene with values of its tracks, but for the members that were edited, as
/// `light.changed` names them. `file`: what the file says of it.
protocol::LightInfo animated(protocol::LightInfo light, const scene::PunctualLight& file,
                             std::span<const TrackValue> values);

/// The same of a material. Members that it cannot have stay absent.
protocol::MaterialInfo animated(protocol::MaterialInfo material, const scene::MaterialLayers& file,
                                std::span<const TrackValue> values);

/// Whether the property is one of the material's extensions (shared::MaterialLayer).
bool is_of_layer(scene::PointedProperty property);

/// Sets the part of a texture transform that the value belongs to.
void animate(scene::TextureTransform& transform, const TrackValue& value);

}  // namespace heliograph::session
