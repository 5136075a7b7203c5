#pragma once

#include "scenes/generator/gltf/document.hpp"
#include "scenes/generator/sky/environment.hpp"

namespace heliograph::scenes {

/// White furnace: a diffuse sphere of base colour 1 and a row of metal ones with roughness 0,
/// 0.25, 0.5, 0.75 and 1. Under a constant environment of radiance 1 nothing may be brighter than
/// the background, and without loss of energy nothing darker.
Document make_furnace();

/// A mirror sphere over a mirror plane.
Document make_mirror();

/// Radiance 1 from everywhere.
Environment make_white_environment();

}  // namespace heliograph::scenes
