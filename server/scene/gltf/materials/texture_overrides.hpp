#pragma once

#include <span>
#include <stop_token>
#include <vector>

#include "scene/gltf/materials/images.hpp"
#include "scene/gltf/materials/textures.hpp"
#include "scene/import_limits.hpp"
#include "scene/scene.hpp"
#include "scene/source_file.hpp"
#include "scene/texture_override.hpp"

namespace heliograph::scene {

/// Replaces textures of the scene's materials, whose slots count textures of `textures`, before
/// images are decoded: adds the files to `images`, and notes in the scene what each slot had. A
/// replaced texture keeps sampler, texCoord set and transform of the slot. What no slot uses any
/// more is not decoded.
/// @return the files that were read, as they were before
/// @throws NoSuchSlot; ImportError where a file cannot be read; LoadCancelled
std::vector<SourceFile> override_textures(std::span<const TextureOverride> overrides, Scene& scene,
                                          TextureTable& textures, std::vector<ImageSource>& images,
                                          const ImportLimits& limits, const std::stop_token& stop);

}  // namespace heliograph::scene
