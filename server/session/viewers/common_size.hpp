#pragma once

#include <cstdint>
#include <span>

namespace heliograph::session {

/// Of frames, pixels.
struct FrameSize {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  bool operator==(const FrameSize&) const = default;
};

/// The size of frames for viewers that want these sizes, at least one, and show the middle of
/// frames that are wider than their windows: the shape of the widest, with as many pixels as the
/// largest has. A camera's angle is that of the height, so each sees what it would see alone.
FrameSize common_size(std::span<const FrameSize> wanted, FrameSize most);

}  // namespace heliograph::session
