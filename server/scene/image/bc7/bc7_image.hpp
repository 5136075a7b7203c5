#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene.hpp"

namespace heliograph::scene {

/// All levels of an image in BC7, the largest first: 16 bytes for each 4 x 4 texels, a row of
/// blocks after the other. Blocks that reach beyond an edge repeat its texels there.
struct Bc7Levels {
  std::vector<std::uint8_t> blocks;
  /// Peak signal to noise ratio over all levels, in dB; infinite without any difference. Errors of
  /// alpha count among those of the three colour channels.
  double signal_to_noise = 0.0;
};

/// On all cores. `pixels` are all levels of the image, RGBA8.
Bc7Levels encode_bc7(const Image& image, std::span<const std::uint8_t> pixels);

}  // namespace heliograph::scene
