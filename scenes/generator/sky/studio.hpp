#pragma once

#include "scenes/generator/sky/environment.hpp"

namespace heliograph::scenes {

/// The studio that the server shows around scenes without an environment, as a file's content.
Environment make_studio(int width, int height);

}  // namespace heliograph::scenes
