#pragma once

#include "scene/scene.hpp"

namespace heliograph::scene {

/// glTF's own model, without extensions.
shared::MaterialLayer plain_layer();

/// Makes scene.layers of what the materials' extensions say, each kind once, and points the
/// materials at them. Surfaces that let light through (KHR_materials_transmission) become blended
/// ones: see README.md. The scene's images must be there: what passes on average depends on them.
void build_layers(Scene& scene);

}  // namespace heliograph::scene
