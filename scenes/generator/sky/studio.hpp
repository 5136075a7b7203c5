#pragma once

#include "scenes/generator/sky/environment.hpp"

namespace heliograph::scenes {

/// A photographer's studio: a grey room with four softboxes (a large key, a long fill, a rim
/// strip, one overhead) that give highlights with crisp, tapered edges. An upward facing surface
/// gets irradiance near pi, so that white comes out near 1.
Environment make_studio(int width, int height);

}  // namespace heliograph::scenes
