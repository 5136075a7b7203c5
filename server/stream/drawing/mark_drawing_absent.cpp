// Replaces mark_drawing.cpp in builds without Pango and Cairo.
#include <stdexcept>

#include "stream/drawing/mark_drawing.hpp"

namespace heliograph::stream {

const std::optional<std::string>& marks_unavailable() {
  static const std::optional<std::string> reason = "this server was built without Pango and Cairo";
  return reason;
}

void draw_marks(std::span<std::uint8_t>, std::uint32_t, std::uint32_t, const ImageMarks&, Alpha) {
  throw std::runtime_error(*marks_unavailable());
}

}  // namespace heliograph::stream
