#pragma once

#include "scene/image/mipmaps.hpp"

namespace heliograph::render {

class Engine;

/// What uploads to the engine's device need of textures (ImportOptions).
scene::KeptTextures kept_textures(Engine& engine);

}  // namespace heliograph::render
