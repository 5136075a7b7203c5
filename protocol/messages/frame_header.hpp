#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "protocol/result.hpp"

namespace heliograph::protocol {

enum class FrameType : std::uint8_t { frame = 1, tile = 2, buffer = 3, timing = 4 };

enum class FrameCodec : std::uint8_t {
  jpeg = 1,
  png = 2,
  webp = 3,
  h264 = 16,
  av1 = 17,
  raw_rgba = 32,
  exr = 33,
};

/// Bits of FrameHeader::flags. Readers ignore bits they do not know.
namespace frame_flag {
inline constexpr std::uint8_t key = 1;               ///< decodable without earlier frames
inline constexpr std::uint8_t final = 2;             ///< no better frame of this state follows
inline constexpr std::uint8_t first_after_drop = 4;  ///< earlier frames were dropped
inline constexpr std::uint8_t discontinuity = 8;     ///< camera jump, resize or new scene
inline constexpr std::uint8_t depth = 16;            ///< a FrameDepth follows the header
}  // namespace frame_flag

inline constexpr std::size_t frame_header_bytes = 64;
inline constexpr std::uint8_t frame_header_version = 1;

/// The header of every binary message to a viewer; the encoded image follows. On the wire: 64
/// bytes, little-endian, in the order of these members after the magic bytes "HVRF".
struct FrameHeader {
  std::uint8_t version = frame_header_version;
  FrameType type = FrameType::frame;
  FrameCodec codec = FrameCodec::jpeg;
  std::uint8_t flags = 0;
  std::uint16_t header_bytes = frame_header_bytes;  ///< where the payload begins
  std::uint16_t quality = 0;                        ///< in the codec's units
  std::uint32_t frame_seq = 0;  ///< per viewer, increasing: gaps are dropped frames
  std::uint32_t render_id = 0;  ///< per session, increasing: equal means the same rendered frame
  std::uint32_t input_seq_echo = 0;  ///< newest camera.set `seq` that this frame shows
  std::uint32_t state_rev = 0;       ///< revision of the session that was rendered
  std::uint16_t width = 0;           ///< of the payload, pixels
  std::uint16_t height = 0;
  std::uint16_t x = 0;  ///< of a tile in the full image, pixels from the top left
  std::uint16_t y = 0;
  std::uint16_t full_width = 0;
  std::uint16_t full_height = 0;
  std::uint64_t render_start_us = 0;  ///< server's monotonic clock
  std::uint32_t render_us = 0;
  std::uint32_t encode_us = 0;
  std::uint32_t queue_us = 0;      ///< end of encoding to start of writing
  std::uint32_t sample_count = 0;  ///< accumulated samples per pixel; 0: raster only

  bool operator==(const FrameHeader&) const = default;
};

std::array<std::uint8_t, frame_header_bytes> encode_frame_header(const FrameHeader& header);

/// Reads the header at the start of `message`. Returns ErrorCode::parse_error, with the field as
/// path, if the message is too short, lacks the magic bytes, has another version, an unknown type
/// or codec, a payload offset outside the message, or an image that is empty or exceeds its full
/// size.
Result<FrameHeader> decode_frame_header(std::span<const std::uint8_t> message);

/// A field of the header, for documents.
struct FrameHeaderField {
  std::string_view name;
  std::size_t offset = 0;
  std::size_t bytes = 0;
  std::string_view meaning;
};

/// All fields in wire order, the magic bytes first.
std::vector<FrameHeaderField> frame_header_fields();

}  // namespace heliograph::protocol
