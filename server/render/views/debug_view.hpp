#pragma once

#include <string_view>

#include "gpu/memory/image.hpp"
#include "render/api/frame_values.hpp"

namespace heliograph::render {

/// A buffer's texels as floats: missing channels are 0, a missing alpha is 1. Waits.
FloatImage read_image(const gpu::Image& image);

/// One texel of it, of the image's own size. Waits.
FloatImage read_texel(const gpu::Image& image, std::uint32_t x, std::uint32_t y);

/// A buffer as a picture for people (paper section 3, stage 9): every kind of signal in the
/// colours that suit it, sRGB RGBA8. Depths and motion are scaled to the frame's own range.
Frame visualise(std::string_view buffer, const FloatImage& values);

}  // namespace heliograph::render
