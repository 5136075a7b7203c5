#pragma once

#include <cstdint>
#include <span>

#include "scene/environment.hpp"

namespace heliograph::scene {

/// Decodes a Radiance picture (.hdr; G. Ward, "Real Pixels", Graphics Gems II, 1991):
/// shared-exponent RGB, run-length encoded in either way or not at all, rows from the top.
/// @throws ImportError
Environment decode_radiance(std::span<const std::uint8_t> file);

}  // namespace heliograph::scene
