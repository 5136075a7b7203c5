#pragma once

#include "scene/scene.hpp"
#include "scene/warnings.hpp"

namespace heliograph::scene {

/// glTF's own model, without extensions.
shared::MaterialLayer plain_layer();

/// Makes scene.layers of what the materials' extensions say, each kind once, and points the
/// materials at them. Light that passes through a surface (KHR_materials_transmission) becomes
/// partial coverage: see README.md.
void build_layers(Scene& scene, Warnings& warnings);

}  // namespace heliograph::scene
