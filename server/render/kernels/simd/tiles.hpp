// Pixels of a tile that trace rays, gathered into full vectors however few they are. Included once
// per instruction set; the guard is Google Highway's convention.
#if defined(HELIOGRAPH_KERNELS_TILES_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_TILES_HPP
#undef HELIOGRAPH_KERNELS_TILES_HPP
#else
#define HELIOGRAPH_KERNELS_TILES_HPP
#endif

#include <algorithm>
#include <array>
#include <cstring>

#include "render/kernels/common/tile.hpp"
#include "render/kernels/simd/material/packed_layer.hpp"
#include "render/kernels/simd/ray_writer.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// Word of a pixel in an image of `words` words a texel.
HWY_INLINE Integer texel_index(const gpu::HostView& image, const PixelLanes& p, int words) {
  const auto pitch = static_cast<int>(image.row_pitch / sizeof(float));
  return hn::Add(hn::Mul(p.y, integer(pitch)), hn::Mul(p.x, integer(words)));
}
HWY_INLINE Float4 gathered_unorm8(const gpu::HostView& image, const PixelLanes& p) {
  return unpack_unorm8(gather(image.data, texel_index(image, p, 1)));
}
HWY_INLINE Float4 gathered4(const gpu::HostView& image, const PixelLanes& p) {
  return gather4(tag, image.row<const float>(0), texel_index(image, p, 4));
}
/// The last of four channels.
HWY_INLINE Float gathered_last(const gpu::HostView& image, const PixelLanes& p) {
  return gather(image.row<const float>(0), hn::Add(texel_index(image, p, 4), integer(3)));
}
/// The first of four channels of 16 bits, 0 to 1.
HWY_INLINE Float gathered_fraction(const gpu::HostView& image, const PixelLanes& p) {
  const Integer words = gather(image.data, texel_index(image, p, 2));
  const Integer first = hn::And(words, integer(0xffff));
  return hn::ConvertTo(tag, first) * number(1.0f / 65535.0f);
}

/// shaders/lib/scene/gbuffer_material.glsl, of the images that a pass reads.
template <bool layered, class Job>
HWY_INLINE auto gbuffer_material(const Job& job, const PixelLanes& pixels, const Float3& eye,
                                 const LobeLanes<Tag>& tables) {
  const Float4 encoded = gathered4(job.normals, pixels);
  const Float4 root = gathered_unorm8(job.base_color, pixels);
  const Float4 packed = gathered_unorm8(job.surface, pixels);
  const Float3 color{root.x * root.x, root.y * root.y, root.z * root.z};
  const Float3 normal = octahedral_decode(encoded.x, encoded.y);
  const Float3 geometric = octahedral_decode(encoded.z, encoded.w);
  if constexpr (layered) {
    Float roughness;
    const auto layer =
        unpack_layer(tag, gathered4(job.layers, pixels), normal, packed.w, roughness);
    return make_material(tag, color, packed.y, roughness, normal, geometric, eye, tables, layer);
  } else {
    return make_material(tag, color, packed.y, packed.x, normal, geometric, eye, tables.split_sum);
  }
}

static_assert(tile_side * tile_side <= ray_batch);

/// Pixels of a tile, in its order.
class PixelList {
 public:
  int size() const { return size_; }

  HWY_INLINE void add(const PixelLanes& pixels, Mask which) {
    size_ += static_cast<int>(hn::CompressStore(pack_pixel(pixels), integer_mask(which),
                                                integer_tag, pixels_.data() + size_));
  }
  /// Those from `first` on; lanes past the last are not `valid`.
  HWY_INLINE PixelLanes from(int first, Mask& valid) const {
    valid = hn::FirstN(tag, static_cast<std::size_t>(size_ - first));
    return unpack_pixel(
        hn::IfThenElseZero(integer_mask(valid), hn::LoadU(integer_tag, pixels_.data() + first)));
  }

 private:
  HWY_ALIGN std::array<int, tile_side * tile_side + hn::MaxLanes(Tag())> pixels_;
  int size_ = 0;
};

/// A row of a tile, or less of it: lanes that are not `inside` hold another pixel of the tile.
struct TileRow {
  PixelLanes pixels;
  Mask inside;
  int x, y;    // of the first lane
  bool whole;  // every lane is inside: pixels lie side by side in memory
};

/// Calls `work(row)` for all pixels of a tile.
template <class Work>
HWY_INLINE void for_each_row(const Tile& tile, const Work& work) {
  const int lanes = static_cast<int>(hn::Lanes(tag));
  for (int y = tile.top; y < tile.bottom; ++y) {
    for (int x = tile.left; x < tile.right; x += lanes) {
      const Integer along = hn::Iota(integer_tag, x), last = integer(tile.right - 1);
      work(TileRow{{hn::Min(along, last), integer(y)},
                   float_mask(hn::Lt(along, integer(tile.right))),
                   x,
                   y,
                   x + lanes <= tile.right});
    }
  }
}

/// Words of an image of one word a texel.
HWY_INLINE Integer row_words(const gpu::HostView& image, const TileRow& row) {
  if (row.whole) return hn::LoadU(integer_tag, image.row<const int>(row.y) + row.x);
  return gather(image.data, texel_index(image, row.pixels, 1));
}
/// The last of four channels.
HWY_INLINE Float row_last(const gpu::HostView& image, const TileRow& row) {
  if (!row.whole) return gathered_last(image, row.pixels);
  Float4 texels;
  hn::LoadInterleaved4(tag, image.row<const float>(row.y) + 4 * row.x, texels.x, texels.y, texels.z,
                       texels.w);
  return texels.w;
}

/// Stores values of one word at the pixels of `which`.
HWY_INLINE void put_values(const gpu::HostView& image, const PixelLanes& pixels, Mask which,
                           Float values) {
  const Texels<1> texels(values);
  const TexelIndices indices(pixels);
  for_each_lane(which, [&](std::size_t lane) { texels.put(image, lane, indices); });
}

HWY_INLINE void put_row(const gpu::HostView& image, const TileRow& row, Float values) {
  if (row.whole) {
    hn::StoreU(values, tag, image.row<float>(row.y) + row.x);
  } else {
    put_values(image, row.pixels, row.inside, values);
  }
}
/// The same of four words.
HWY_INLINE void put_row(const gpu::HostView& image, const TileRow& row, const Float4& values) {
  if (row.whole) {
    hn::StoreInterleaved4(values.x, values.y, values.z, values.w, tag,
                          image.row<float>(row.y) + 4 * row.x);
    return;
  }
  const Texels<4> texels(values);
  const TexelIndices indices(row.pixels);
  for_each_lane(row.inside, [&](std::size_t lane) { texels.put(image, lane, indices); });
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
