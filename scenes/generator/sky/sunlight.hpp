#pragma once

#include "scenes/generator/gltf/document.hpp"
#include "scenes/generator/sky/sky.hpp"

namespace heliograph::scenes {

/// Where the sun stands (direction_to_sun), and the full cone it is seen under: the paper's shadow
/// angle. All degrees.
struct Sun {
  float elevation = 45.0f;
  float azimuth = 0.0f;
  float angular_diameter = 0.53f;
};

/// Adds the node `sun`, as strong as the sun of `sky`.
void add_sun(Document& document, const Sun& sun, const ClearSky& sky);

}  // namespace heliograph::scenes
