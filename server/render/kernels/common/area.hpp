#pragma once

namespace heliograph::render::kernels {

/// Pixels that one thread works on.
struct Area {
  int left, right, top, bottom;
  int width() const { return right - left; }
};

/// A frame in areas of equal size, up to a pixel.
struct Areas {
  int columns, rows;
  int count() const { return columns * rows; }
  Area at(int index, int width, int height) const {
    const int column = index % columns, row = index / columns;
    return {column * width / columns, (column + 1) * width / columns, row * height / rows,
            (row + 1) * height / rows};
  }
};

}  // namespace heliograph::render::kernels
