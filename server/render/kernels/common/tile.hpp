#pragma once

#include <algorithm>

#include "render/kernels/common/parallel.hpp"

namespace heliograph::render::kernels {

/// Pixels whose rays lie together in a stream: neighbours see the same part of the scene.
inline constexpr int tile_shift = 4;
inline constexpr int tile_side = 1 << tile_shift;

/// Pixels from (left, top) to before (right, bottom).
struct Tile {
  int left, top, right, bottom;
};

/// Rows of an image, from `top`, which begins a tile, to before `bottom`.
struct Rows {
  int top, bottom;
  /// Of these the first `height` of the image.
  Rows within(int height) const { return {std::min(top, height), std::min(bottom, height)}; }
};

/// Calls `work(tile)` for all tiles of some rows, on all processors.
template <class Work>
void for_each_tile(int width, Rows rows, const Work& work) {
  const int across = (width + tile_side - 1) / tile_side;
  const int tiles = across * ((rows.bottom - rows.top + tile_side - 1) / tile_side);
  for_each_range(tiles, 1, [&](int first, int last) {
    for (int tile = first; tile < last; ++tile) {
      const int left = tile % across * tile_side, top = rows.top + tile / across * tile_side;
      work(Tile{left, top, std::min(left + tile_side, width),
                std::min(top + tile_side, rows.bottom)});
    }
  });
}

}  // namespace heliograph::render::kernels
