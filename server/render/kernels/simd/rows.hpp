#pragma once

// For the sources of host kernels: which instruction sets they are made for, and their threads.
// To be included before any header of Google Highway.

#include <algorithm>
#include <memory>

#include "render/kernels/parallel.hpp"

// The baseline, AVX2 and AVX-512: what lies between is hardly ever met.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)

namespace heliograph::render::kernels {

/// Rows that one thread works on at a time.
inline constexpr int band_rows = 8;

/// Calls `work(first, last)` for bands of the rows 0 to `height`, on all processors.
inline void for_each_band(int height, RangeWork work) {
  for_each_range(height, band_rows, work);
}

/// Channels of a band of rows, each by itself, with `reach` more rows and columns on every side.
class BandScratch {
 public:
  BandScratch(int channels, int width, int first, int last, int half_extent)
      : width_(width),
        reach_(half_extent),
        first_(first - half_extent),
        rows_(last - first + 2 * half_extent),
        values_(std::make_unique_for_overwrite<float[]>(
            static_cast<std::size_t>(channels * rows_ * pitch()))) {}

  /// Of row `y`, at column 0.
  float* row(int channel, int y) const {
    return values_.get() + (channel * rows_ + y - first_) * pitch() + reach_;
  }
  /// Columns beyond the edges take the values at the edges.
  void extend(int channel, int y) const {
    float* const values = row(channel, y);
    std::fill_n(values - reach_, reach_, values[0]);
    std::fill_n(values + width_, reach_, values[width_ - 1]);
  }
  void fill_beyond(int channel, int y, float value) const {
    float* const values = row(channel, y);
    std::fill_n(values - reach_, reach_, value);
    std::fill_n(values + width_, reach_, value);
  }

 private:
  int pitch() const { return width_ + 2 * reach_; }

  int width_;
  int reach_;
  int first_;
  int rows_;
  std::unique_ptr<float[]> values_;
};

}  // namespace heliograph::render::kernels
