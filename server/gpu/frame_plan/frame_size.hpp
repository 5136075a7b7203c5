#pragma once

#include <cstdint>

#include "gpu/device/vulkan.hpp"

namespace heliograph::gpu {

/// Width and height of an image or of a dispatch: fixed, or by the size that a plan's frames are
/// drawn at, which may change between frames.
class FrameSize {
 public:
  FrameSize(VkExtent2D fixed) : fixed_(fixed) {}
  FrameSize(std::uint32_t width, std::uint32_t height) : fixed_{width, height} {}
  /// One for each square of `side` by `side` pixels, also for those that the border cuts.
  static FrameSize squares(std::uint32_t side) {
    FrameSize size(0, 0);
    size.side_ = side;
    return size;
  }

  bool follows_frame() const { return side_ > 0; }
  /// The same for frames of one texel for each square of `side` by `side` pixels.
  FrameSize reduced(std::uint32_t side) const {
    return follows_frame() ? squares(side_ * side) : *this;
  }
  /// Where frames have this size.
  VkExtent2D of(VkExtent2D frame) const {
    if (!follows_frame()) return fixed_;
    return {(frame.width + side_ - 1) / side_, (frame.height + side_ - 1) / side_};
  }

 private:
  VkExtent2D fixed_;
  std::uint32_t side_ = 0;
};

/// The size of the frame itself.
inline FrameSize each_pixel() {
  return FrameSize::squares(1);
}

}  // namespace heliograph::gpu
