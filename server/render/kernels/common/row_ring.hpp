#pragma once

#include <algorithm>
#include <cstddef>

#include "hwy/aligned_allocator.h"

namespace heliograph::render::kernels {

/// The newest rows of a part of an image in planes: every channel by itself, so that vectors of any
/// pixels side by side are plain loads. A row takes the place of the one `rows` before it.
class RowRing {
 public:
  /// `margin`: columns on both sides that may be read, zero until they are written.
  RowRing(int planes, int width, int margin, int rows)
      : margin_(rounded_up(margin)),
        pitch_(rounded_up(width) + 2 * margin_),
        planes_(planes),
        rows_(rows),
        values_(hwy::AllocateAligned<float>(static_cast<std::size_t>(pitch_ * planes * rows))) {
    for (int row = 0; row < planes * rows; ++row) {
      float* const first = values_.get() + static_cast<std::ptrdiff_t>(row) * pitch_;
      std::fill_n(first, margin_, 0.0f);
      std::fill_n(first + margin_ + width, pitch_ - margin_ - width, 0.0f);
    }
  }

  /// The first plane of row `y` >= 0 at column 0; the next plane begins pitch() floats on.
  float* row(int y) const {
    return values_.get() + static_cast<std::ptrdiff_t>(y % rows_) * planes_ * pitch_ + margin_;
  }
  int pitch() const { return pitch_; }

 private:
  /// To whole vectors of any width.
  static int rounded_up(int columns) { return (columns + 15) / 16 * 16; }

  int margin_;
  int pitch_;
  int planes_;
  int rows_;
  hwy::AlignedFreeUniquePtr<float[]> values_;
};

}  // namespace heliograph::render::kernels
