#include "render/kernels/simd/rows.hpp"
#include "render/kernels/specular.hpp"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/specular_rays.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/simd/specular_lobe.hpp"

#ifndef HELIOGRAPH_SPECULAR_TILE
#define HELIOGRAPH_SPECULAR_TILE
namespace heliograph::render::kernels {

/// Cells whose rays lie together in the stream: neighbours see the same part of the scene.
inline constexpr int tile_side = 16;

struct Cells {
  int width, height;
};

}  // namespace heliograph::render::kernels
#endif

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

class Generation {
 public:
  explicit Generation(const SpecularRaysJob& job)
      : job_(job),
        frame_(job.frame),
        camera_(job.frame),
        split_sum_(job.split_sum.texels, job.split_sum.size),
        scale_(job.directions ? 2 : 1),
        random_(specular_pairs(job.frame, 4, scale_)) {}

  /// @return how many rays there are, which lie at `made`
  HWY_INLINE std::size_t block(const PixelLanes& cell, Mask inside, shared::Ray* made) const {
    const PixelLanes pixel = traced_pixel(cell);
    const Integer motion = texel_index(job_.motion, pixel, 4);
    const Float view_z = gather(job_.motion.row<const float>(0), hn::Add(motion, integer(3)));
    const Float4 packed = unorm8(job_.surface, pixel);
    Mask requested = hn::And(inside, hn::Gt(view_z, zero()));
    requested = hn::And(requested, hn::Le(packed.z, number(0.5f)));  // not unlit
    if (none(requested)) return 0;

    const Float4 color = unorm8(job_.base_color, pixel);
    const Float4 encoded =
        gather4(tag, job_.normals.row<const float>(0), texel_index(job_.normals, pixel, 4));
    const MaterialLanes m =
        make_material(tag, Float3{color.x * color.x, color.y * color.y, color.z * color.z},
                      packed.y, packed.x, octahedral_decode(encoded.x, encoded.y),
                      octahedral_decode(encoded.z, encoded.w), camera_.to_eye(pixel), split_sum_);
    Float2 u;
    random_.at(as_unsigned(cell.x), as_unsigned(cell.y), u.x, u.y);
    const SpecularSample s = sample_specular(m, u);
    const Float3& albedo = m.specular_albedo;
    RayLanes ray;
    ray.user = {s.weight.x / at_least(albedo.x, 1e-3f), s.weight.y / at_least(albedo.y, 1e-3f),
                s.weight.z / at_least(albedo.z, 1e-3f)};
    const auto positive = [](Float v) { return hn::Gt(v, zero()); };
    const Mask valid =
        hn::Or(positive(ray.user.x), hn::Or(positive(ray.user.y), positive(ray.user.z)));
    if (job_.directions) {
      put_directions(cell, s, requested);
      ray.user = numbers(1.0f);
    }
    // Roughness is stored in steps of 1 / 255: a little more than half of one is still the same.
    const Mask smooth = hn::Le(m.roughness, number(job_.constants.max_roughness + 0.6f / 255.0f));
    ray.origin = offset_origin(camera_.world_position(pixel, view_z), m.geometric, view_z);
    ray.direction = s.direction;
    ray.t_min = zero();
    ray.t_max = number(1e30f);
    ray.pixel = pack_pixel(pixel);
    return store_rays(ray, hn::And(requested, hn::And(smooth, valid)), made);
  }

 private:
  /// Word of a pixel in an image of `words` words a texel.
  static HWY_INLINE Integer texel_index(const gpu::HostView& image, const PixelLanes& p,
                                        int words) {
    const auto pitch = static_cast<int>(image.row_pitch / sizeof(float));
    return hn::Add(hn::Mul(p.y, integer(pitch)), hn::Mul(p.x, integer(words)));
  }
  static HWY_INLINE Float4 unorm8(const gpu::HostView& image, const PixelLanes& p) {
    return unpack_unorm8(gather(image.data, texel_index(image, p, 1)));
  }

  /// The pixel that traces for a cell: of 2 x 2 another in every frame.
  HWY_INLINE PixelLanes traced_pixel(const PixelLanes& cell) const {
    if (scale_ == 1) return cell;
    const std::uint32_t phase = frame_.sample_index & 3u;
    const auto within = [&](Integer c, std::uint32_t step, std::uint32_t size) {
      const Integer at = hn::Add(hn::Add(c, c), integer(static_cast<int>(step)));
      return hn::Min(at, integer(static_cast<int>(size) - 1));
    };
    return {within(cell.x, (phase ^ (phase >> 1u)) & 1u, frame_.extent.x),
            within(cell.y, phase & 1u, frame_.extent.y)};
  }

  HWY_INLINE void put_directions(const PixelLanes& cell, const SpecularSample& s,
                                 Mask requested) const {
    const Texels<4> texels(Float4{s.direction.x, s.direction.y, s.direction.z, s.density});
    const TexelIndices indices(cell);
    for_each_lane(requested, [&](std::size_t lane) { texels.put(job_.directions, lane, indices); });
  }

  const SpecularRaysJob& job_;
  const shared::FrameConstants& frame_;
  CameraLanes camera_;
  SquareTable<Tag> split_sum_;
  int scale_;
  RandomPairs<UnsignedTag> random_;
};

void make_tile(const SpecularRaysJob& job, const Cells& cells, int tile_x, int tile_y) {
  const int left = tile_x * tile_side, top = tile_y * tile_side;
  const int right = std::min(left + tile_side, cells.width);
  const int bottom = std::min(top + tile_side, cells.height);
  for (int y = top; y < bottom; ++y) {
    float* const row = job.radiance.row<float>(static_cast<std::uint32_t>(y));
    std::fill(row + 4 * left, row + 4 * right, 0.0f);
    if (!job.directions) continue;
    float* const directions = job.directions.row<float>(static_cast<std::uint32_t>(y));
    std::fill(directions + 4 * left, directions + 4 * right, 0.0f);
  }
  const Generation generation(job);
  std::array<shared::Ray, tile_side * tile_side> made;
  std::size_t count = 0;
  for (int i = 0; i < tile_side * tile_side; i += static_cast<int>(hn::Lanes(tag))) {
    const Integer index = hn::Iota(integer_tag, i);
    const Integer x = hn::Add(integer(left), hn::And(index, integer(tile_side - 1)));
    const Integer y = hn::Add(integer(top), hn::ShiftRight<4>(index));
    const PixelLanes cell{hn::Min(x, integer(right - 1)), hn::Min(y, integer(bottom - 1))};
    const Mask inside = float_mask(hn::And(hn::Eq(x, cell.x), hn::Eq(y, cell.y)));
    if (!none(inside)) count += generation.block(cell, inside, made.data() + count);
  }
  if (count) job.rays.append({made.data(), count});
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(make_tile);

void specular_rays(const SpecularRaysJob& job) {
  const int scale = job.directions ? 2 : 1;
  const Cells cells{(static_cast<int>(job.frame.extent.x) + scale - 1) / scale,
                    (static_cast<int>(job.frame.extent.y) + scale - 1) / scale};
  const int across = (cells.width + tile_side - 1) / tile_side;
  const int tiles = across * ((cells.height + tile_side - 1) / tile_side);
  for_each_range(tiles, 1, [&](int first, int last) {
    for (int tile = first; tile < last; ++tile) {
      HWY_DYNAMIC_DISPATCH(make_tile)(job, cells, tile % across, tile / across);
    }
  });
  job.rays.end();
}

}  // namespace heliograph::render::kernels
#endif
