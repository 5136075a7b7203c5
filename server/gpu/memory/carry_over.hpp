#pragma once

#include "gpu/memory/image.hpp"

namespace heliograph::gpu {

/// Fills an image with the nearest texels of another of the same format, level 0 of one layer;
/// waits.
void carry_over(const Device& device, const Image& from, const Image& to);
/// Fills a buffer with the bytes of another of the same size; waits.
void carry_over(const Device& device, const Buffer& from, const Buffer& to);

}  // namespace heliograph::gpu
