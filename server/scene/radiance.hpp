#pragma once

#include <cstdint>
#include <span>

#include "scene/environment.hpp"

namespace heliograph::scene {

/// Decodes a Radiance picture (.hdr; G. Ward, "Real Pixels", Graphics Gems II, 1991):
/// shared-exponent RGB, run-length encoded in either way or not at all, rows from the top.
/// stb_image, which decodes the other pictures, takes cut files for whole ones here, and can loop
/// forever on them.
/// @throws ImportError
Environment decode_radiance(std::span<const std::uint8_t> file);

}  // namespace heliograph::scene
