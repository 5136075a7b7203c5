#pragma once

// For the sources of host kernels: which instruction sets they are made for, and their threads.
// To be included before any header of Google Highway.

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

// The baseline, AVX2 and AVX-512: what lies between is hardly ever met.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)

namespace heliograph::render::host {

/// Rows that one thread works on at a time.
inline constexpr int band_rows = 8;

/// Calls `work(first, last)` for bands of the rows 0 to `height`, on all processors.
template <class Work>
void for_each_band(int height, const Work& work) {
  const int bands = (height + band_rows - 1) / band_rows;
  tbb::parallel_for(tbb::blocked_range<int>(0, bands, 1), [&](const auto& some) {
    for (int band = some.begin(); band < some.end(); ++band) {
      work(band * band_rows, std::min((band + 1) * band_rows, height));
    }
  });
}

}  // namespace heliograph::render::host
