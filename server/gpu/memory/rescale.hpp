#pragma once

#include "gpu/memory/image.hpp"

namespace heliograph::gpu {

/// Scales the part of an image that starts at its first texel from one size to another by the
/// nearest texel: level 0 of one layer; waits. What lies outside of `to` has no defined content.
/// @param scratch an image of the same format and size, which loses its content where the device
///        is no processor
void rescale(const Device& device, const Image& image, const Image& scratch, VkExtent2D from,
             VkExtent2D to);

}  // namespace heliograph::gpu
