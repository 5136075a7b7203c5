#pragma once

#include "render/api/engine.hpp"

namespace heliograph::cli {

/// On a CPU device, images are heap blocks of this process. By default glibc raises its mmap
/// threshold up to 32 MB, so that images and textures come from the arenas, where freed memory
/// stays. With a fixed threshold they are mapped, and returned to the system when freed: after a
/// dozen sessions the process takes 240 MB instead of 460, and images of 19 models 371 instead of
/// 401. Free memory at an arena's end is kept up to a size, or every frame would allocate its
/// working memory again. With a GPU nothing is changed: only encoded frames would be mapped, at a
/// cost of 2 to 3 ms for each of 1920x1080.
void set_malloc_thresholds(const render::Engine& engine);

}  // namespace heliograph::cli
