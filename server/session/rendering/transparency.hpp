#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <vector>

// Images with another background than the renderer draws. Coverage is what a white background shows
// more than a black one, in samples without any light, which take hardly any time; the colors are
// those over a black background.

namespace heliograph::session {

/// As many samples as the edges of 8-bit alpha need.
inline constexpr std::uint32_t coverage_samples = 32;

enum class CoverageBackground { white, black };

/// A patch of settings in which only the background sends light.
nlohmann::json coverage_settings(CoverageBackground background);

/// How much of each pixel surfaces cover, 0 to 1, from the radiance over white and over black:
/// RGBA.
std::vector<float> coverage_of(std::span<const float> over_white,
                               std::span<const float> over_black);

/// Puts a linear color behind an image over black (sRGB, RGBA); without one, makes it transparent.
/// What shines without covering, such as reflections in glass, adds to the background.
void put_background(std::span<std::uint8_t> rgba, std::span<const float> coverage,
                    const std::optional<std::array<float, 3>>& color);

}  // namespace heliograph::session
