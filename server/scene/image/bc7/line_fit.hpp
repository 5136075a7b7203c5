#pragma once

#include <array>
#include <cstdint>

#include "scene/image/bc7/format.hpp"

namespace heliograph::scene::bc7 {

/// A value for each texel of a block.
struct alignas(16) Plane {
  std::array<float, texels_of_block> of{};
};

/// Texels of a block that share a line of colours.
struct Cluster {
  std::array<const Plane*, 4> channels{};  // as many as the line's format has, 0..255
  const Plane* members = nullptr;          // 1 for texels that belong to it, else 0
  bool opaque = false;                     // the fourth channel is 255 everywhere
};

/// A line as it is stored, and what it makes of the texels.
struct LineFit {
  std::array<std::array<std::uint8_t, 4>, 2> codes{};  // ends, without their low bits
  std::array<std::uint8_t, 2> low_bits{};
  Plane indices;
  float error = 0.0f;  // sum of squared differences of all members and channels
};

/// The principal axis of a cluster's first `channels` channels, and how far texels are from it.
struct PrincipalAxis {
  std::array<float, 4> mean{};
  std::array<float, 4> direction{};  // unit length, or 0 where all texels are alike
  std::array<float, 4> residual{};   // by channel: sum of squared distances from the axis
  float first = 0.0f, last = 0.0f;   // where texels begin and end on it, from the mean

  float distance() const { return residual[0] + residual[1] + residual[2] + residual[3]; }
};
PrincipalAxis principal_axis(const Cluster& cluster, int channels);

/// The line that fits best: along the axis, then by least squares, at most `refinements` times.
LineFit fit_line(const Cluster& cluster, const PrincipalAxis& axis, const LineFormat& format,
                 int refinements);

}  // namespace heliograph::scene::bc7
