#pragma once

#include <span>

#include "scene/scene.hpp"

namespace heliograph::scene {

/// glTF's base material, without extensions.
shared::MaterialLayer plain_layer();
/// Whether a material with this layer looks like one without extensions.
bool adds_nothing(const shared::MaterialLayer& layer);

/// Whether any of them scatters light to the other side of its surfaces
/// (KHR_materials_diffuse_transmission).
bool scatters_through(std::span<const shared::MaterialLayer> layers);

/// Whether any of them splits light into its colours.
bool disperses(std::span<const shared::MaterialLayer> layers);

/// The layer of a material with these extensions. With an alpha mask it transmits nothing but
/// diffuse light.
shared::MaterialLayer layer_of(const shared::Material& material, const MaterialLayers& from);

/// Creates scene.layers from the materials' extensions, without duplicates, and links the materials
/// to them. Transmissive surfaces (KHR_materials_transmission) become blended ones: see README.md.
/// The scene's images must be decoded and its instances placed, because the mean transmission
/// depends on them.
void build_layers(Scene& scene);

}  // namespace heliograph::scene
