#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "protocol/messages/stream_kinds.hpp"

namespace heliograph::stream {

/// Parameters of an encoding; viewers with equal variants share the encoded frame.
struct EncodingVariant {
  protocol::StreamCodec codec = protocol::StreamCodec::jpeg;
  int scale = 100;   // percent of the frame's width and height
  int quality = 80;  // 1 to 100

  friend auto operator<=>(const EncodingVariant&, const EncodingVariant&) = default;
};

/// Position of a frame in a video. Frames other than key frames depend on the previous one.
struct VideoPosition {
  std::uint64_t video = 0;  // unique to each run of an encoder
  std::uint32_t index = 0;

  bool follows(const VideoPosition& other) const {
    return video == other.video && index == other.index + 1;
  }
};

/// Maximum number of encodings of a moving frame, for any number of viewers.
inline constexpr std::size_t max_variants = 3;

/// Approximate size of a frame in this variant, relative to JPEG at quality 80.
double relative_bytes(const EncodingVariant& variant);

/// The variants to encode for viewers that request `requested`: all, if they are few enough,
/// otherwise the cheapest, the most expensive and the middle one of each codec, with one kept for
/// JPEG if a viewer needs it. Ascending, without duplicates.
std::vector<EncodingVariant> reduce_variants(std::vector<EncodingVariant> requested);

/// The one of `variants` for a viewer that requests `requested`: the most expensive one of its
/// codec that is no more expensive than requested, otherwise the cheapest. `variants` contains at
/// least one of its codec.
EncodingVariant assigned_variant(const std::vector<EncodingVariant>& variants,
                                 const EncodingVariant& requested);

}  // namespace heliograph::stream
