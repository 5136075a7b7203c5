#include "session/viewers/common_size.hpp"

#include <algorithm>
#include <cmath>

namespace heliograph::session {
namespace {

double shape_of(const FrameSize& size) {
  return static_cast<double>(size.width) / size.height;
}

double pixels_of(const FrameSize& size) {
  return static_cast<double>(size.width) * size.height;
}

std::uint32_t frame_side(double side) {
  return std::max(1u, static_cast<std::uint32_t>(std::lround(side)));
}

}  // namespace

FrameSize common_size(std::span<const FrameSize> wanted, FrameSize most) {
  const FrameSize widest = *std::ranges::max_element(wanted, {}, shape_of);
  const FrameSize largest = *std::ranges::max_element(wanted, {}, pixels_of);
  const double shape = shape_of(widest);
  const double height =
      std::min({std::sqrt(pixels_of(largest) / shape), double(most.height), most.width / shape});
  // Rounding must not change what a viewer alone has asked for.
  if (pixels_of(widest) == pixels_of(largest)) return widest;
  return {frame_side(height * shape), frame_side(height)};
}

}  // namespace heliograph::session
