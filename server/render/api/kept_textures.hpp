#pragma once

#include <cstdint>

namespace heliograph::render {

class Engine;

/// Compute shaders and kernels read levels of textures with no longer side, in texels; fewer where
/// the device cannot address so many texels in one buffer.
inline constexpr std::uint32_t longest_heap_side = 1024;

/// Levels of textures whose sides are longer are not needed for an upload (ImportOptions).
std::uint32_t longest_kept_side(Engine& engine);

}  // namespace heliograph::render
