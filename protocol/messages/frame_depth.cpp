#include "protocol/messages/frame_depth.hpp"

#include <bit>

namespace heliograph::protocol {
namespace {

/// The sample that a plane through its neighbours would have.
std::uint16_t predicted_depth(std::span<const std::uint16_t> samples, std::size_t i,
                              std::size_t width) {
  const bool left = i % width > 0;
  const bool above = i >= width;
  const int on_left = left ? samples[i - 1] : 0;
  const int on_top = above ? samples[i - width] : 0;
  const int corner = left && above ? samples[i - width - 1] : 0;
  return static_cast<std::uint16_t>(on_left + on_top - corner);
}

void put_word(std::vector<std::uint8_t>& bytes, std::uint32_t value, int size) {
  for (int i = 0; i < size; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

void put_floats(std::vector<std::uint8_t>& bytes, std::span<const float> values) {
  for (const float value : values) put_word(bytes, std::bit_cast<std::uint32_t>(value), 4);
}

}  // namespace

std::vector<std::uint8_t> depth_differences(std::span<const std::uint16_t> samples,
                                            std::size_t width) {
  const std::size_t count = samples.size();
  std::vector<std::uint8_t> bytes(2 * count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto difference =
        static_cast<std::int16_t>(samples[i] - predicted_depth(samples, i, width));
    const auto folded = static_cast<std::uint16_t>((difference << 1) ^ (difference >> 15));
    bytes[i] = static_cast<std::uint8_t>(folded);
    bytes[count + i] = static_cast<std::uint8_t>(folded >> 8);
  }
  return bytes;
}

std::vector<std::uint8_t> encode_frame_depth(const FrameDepth& depth,
                                             std::span<const std::uint8_t> compressed) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(frame_depth_bytes + compressed.size());
  put_word(bytes, depth.width, 2);
  put_word(bytes, depth.height, 2);
  put_floats(bytes, {&depth.nearest, 1});
  put_floats(bytes, depth.eye);
  put_floats(bytes, depth.target);
  put_floats(bytes, depth.up);
  put_floats(bytes, {&depth.vertical_fov, 1});
  put_word(bytes, static_cast<std::uint32_t>(compressed.size()), 4);
  bytes.insert(bytes.end(), compressed.begin(), compressed.end());
  return bytes;
}

}  // namespace heliograph::protocol
