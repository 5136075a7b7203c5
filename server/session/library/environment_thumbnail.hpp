#pragma once

#include <cstdint>
#include <vector>

#include "scene/environment.hpp"

namespace heliograph::session {

/// A small image of an environment for people who choose one, as a PNG file: exposed by its mean
/// luminance, tone mapped with x / (1 + x), in sRGB.
std::vector<std::uint8_t> environment_thumbnail(const scene::Environment& environment);

}  // namespace heliograph::session
