#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "protocol/result.hpp"

namespace heliograph::protocol {

/// Samples of a depth plane, at most: it lies in the header, whose length has 16 bits.
inline constexpr std::size_t max_depth_samples = 24576;

/// The camera of a frame and where its surfaces are, coarsely: what a client needs to show the
/// frame from another camera until the next one comes. It follows the frame header of viewers that
/// asked for it (frame_flag::depth), as little-endian numbers in the order of these members.
struct FrameDepth {
  std::uint16_t width = 0;  ///< samples in a row; they cover the frame
  std::uint16_t height = 0;
  float nearest = 0.0f;  ///< metres along the view, of the nearest sample
  std::array<float, 3> eye{};
  std::array<float, 3> target{};
  std::array<float, 3> up{};
  float vertical_fov = 0.0f;  ///< degrees
  /// Row 0 on top: 65535 * nearest / distance along the view; 0: the background. On the wire they
  /// are compressed (zlib) behind the number of bytes: differences from left + above - above left,
  /// with the sign in the lowest bit, all low bytes before all high bytes.
  std::vector<std::uint16_t> samples;

  bool operator==(const FrameDepth&) const = default;
};

inline constexpr std::size_t frame_depth_bytes = 52;  ///< before the compressed samples

/// The differences that are compressed.
std::vector<std::uint8_t> depth_differences(std::span<const std::uint16_t> samples,
                                            std::size_t width);

/// What follows the frame header; `compressed` are the differences.
std::vector<std::uint8_t> encode_frame_depth(const FrameDepth& depth,
                                             std::span<const std::uint8_t> compressed);

}  // namespace heliograph::protocol
