#pragma once

#include "scenes/generator/atrium/atrium_materials.hpp"
#include "scenes/generator/gltf/document.hpp"
#include "scenes/generator/sky/sky.hpp"

namespace heliograph::scenes {

inline constexpr float sun_elevation = 68.0f;  // degrees
inline constexpr float sun_azimuth = 20.0f;

/// The atrium of the paper's Glossy Sponza, lit by the sun of `sky` and by hanging lights.
/// `case_number` 1 to 3 chooses the glossy materials and which camera is `main`.
Document make_atrium(int case_number, const ClearSky& sky);

}  // namespace heliograph::scenes
