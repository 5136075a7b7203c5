#pragma once

#include "scene/scene.hpp"

namespace heliograph::scene {

/// glTF's base material, without extensions.
shared::MaterialLayer plain_layer();

/// Creates scene.layers from the materials' extensions, without duplicates, and links the materials
/// to them. Transmissive surfaces (KHR_materials_transmission) become blended ones: see README.md.
/// The scene's images must be decoded, because the mean transmission depends on them.
void build_layers(Scene& scene);

}  // namespace heliograph::scene
