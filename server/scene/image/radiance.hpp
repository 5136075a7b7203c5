#pragma once

#include <cstdint>
#include <span>

#include "scene/environment.hpp"
#include "scene/image/image_size.hpp"

namespace heliograph::scene {

/// Decodes a Radiance image (.hdr; G. Ward, "Real Pixels", Graphics Gems II, 1991): shared-exponent
/// RGB, uncompressed or with either run-length encoding, top row first.
/// @throws ImportError, also when there are more than `most_pixels`
Environment decode_radiance(std::span<const std::uint8_t> file,
                            std::uint64_t most_pixels = most_environment_pixels);

}  // namespace heliograph::scene
