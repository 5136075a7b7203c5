#pragma once

#include "scene/scene.hpp"

namespace heliograph::scene {

/// A scene whose images are not decoded yet, without any texture: it shares the lists of `scene`.
/// Factors count as in the file, but what a texture most often takes away is taken away: emission,
/// metalness and transmission of textures. Surfaces with a mask of alpha are whole.
Scene without_textures(const Scene& scene);

}  // namespace heliograph::scene
