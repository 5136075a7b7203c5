#pragma once

#include <string_view>

#include "gpu/memory/image.hpp"
#include "render/api/frame_values.hpp"

namespace heliograph::render {

/// The texels of a buffer from the first one to `size` as floats: missing channels are 0, a missing
/// alpha is 1. Waits.
FloatImage read_image(const gpu::Image& image, VkExtent2D size);

/// One texel of it, of the image's own size. Waits.
FloatImage read_texel(const gpu::Image& image, std::uint32_t x, std::uint32_t y);

}  // namespace heliograph::render
