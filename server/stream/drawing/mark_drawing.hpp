#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "stream/encoders/image_view.hpp"

namespace heliograph::stream {

/// In fractions of the image from the top left corner; may lie outside of it.
struct MarkPoint {
  double x = 0.0;
  double y = 0.0;
};

struct MarkLine {
  MarkPoint from;
  MarkPoint to;
  bool thin = false;
};

/// A text on a plate, centred at a point.
struct MarkLabel {
  MarkPoint at;
  std::string text;  // UTF-8
};

/// A numbered pin with a text beside it.
struct MarkPin {
  MarkPoint at;
  std::uint32_t number = 0;
  std::string author;   // UTF-8, may be empty
  std::string text;     // UTF-8
  bool hidden = false;  ///< behind a surface: faint, without its text
};

/// What is drawn over an image: measurements and annotations. Later ones cover earlier ones; lines
/// lie below points, points below pins, pins below texts.
struct ImageMarks {
  std::vector<MarkLine> lines;
  std::vector<MarkPoint> points;
  std::vector<MarkLabel> labels;
  std::vector<MarkPin> pins;

  bool empty() const { return lines.empty() && points.empty() && labels.empty() && pins.empty(); }
};

/// Why marks cannot be drawn here; nullopt if they can.
const std::optional<std::string>& marks_unavailable();

/// Draws over the pixels of an image as ImageView has them, in sizes that follow its height. With
/// Alpha::kept the alpha of what is drawn is that of the marks over the image's; else it stays.
/// @throws std::runtime_error where marks_unavailable() or the drawing fails;
/// std::invalid_argument if `rgba` does not have the size
void draw_marks(std::span<std::uint8_t> rgba, std::uint32_t width, std::uint32_t height,
                const ImageMarks& marks, Alpha alpha = Alpha::ignored);

}  // namespace heliograph::stream
