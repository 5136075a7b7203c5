// What the reference path tracer remembers of paths, and the random numbers that they use, in
// vectors. Included once per instruction set; the guard is Google Highway's convention.
#if defined(HELIOGRAPH_KERNELS_PATH_STATE_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_PATH_STATE_HPP
#undef HELIOGRAPH_KERNELS_PATH_STATE_HPP
#else
#define HELIOGRAPH_KERNELS_PATH_STATE_HPP
#endif

#include <cstring>

#include "render/kernels/simd/random.hpp"
#include "render/kernels/simd/ray_writer.hpp"
#include "shaders/shared/reference.h"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// shared::ReferencePath; bounces are whole numbers.
struct PathLanes {
  Float3 throughput;
  Float bounces, cone_width, cone_spread;
  Integer flags;
  Float density;

  HWY_INLINE Mask left_by_specular() const {
    const Integer flag = integer(static_cast<int>(shared::path_specular));
    return float_mask(hn::Eq(hn::And(flags, flag), flag));
  }
  /// Of the camera's rays, perhaps refracted.
  HWY_INLINE Mask is_seen() const {
    const Integer flag = integer(static_cast<int>(shared::path_turned));
    return float_mask(hn::Eq(hn::And(flags, flag), integer(0)));
  }
  /// Of those that have met nothing but what they went straight on through.
  HWY_INLINE Mask is_camera_ray() const {
    const Integer met = hn::And(flags, integer(~static_cast<int>(shared::path_kept)));
    return float_mask(hn::Eq(met, integer(0)));
  }
  HWY_INLINE Integer band() const {
    return hn::And(hn::ShiftRight<shared::path_band_shift>(flags),
                   integer(static_cast<int>(shared::path_bands)));
  }
  /// Number of the layer whose volume the path is in; 0: none.
  HWY_INLINE Integer medium() const { return hn::ShiftRight<shared::path_medium_shift>(flags); }
  HWY_INLINE void enter(Integer medium) {
    const Integer others = hn::And(flags, integer((1 << shared::path_medium_shift) - 1));
    flags = hn::Or(others, hn::ShiftLeft<shared::path_medium_shift>(medium));
  }
};

HWY_INLINE Integer pixel_index(const shared::FrameConstants& frame, const PixelLanes& p) {
  return hn::Add(hn::Mul(p.y, integer(static_cast<int>(frame.extent.x))), p.x);
}

/// Of the camera's rays.
HWY_INLINE PathLanes first_paths(const shared::FrameConstants& frame) {
  const glm::vec2 cone = CameraLanes(frame).cone();
  return {numbers(1.0f), zero(), number(cone.x), number(cone.y), integer(0), zero()};
}

HWY_INLINE PathLanes load_paths(const shared::ReferencePath* paths, Integer index) {
  static_assert(sizeof(shared::ReferencePath) == 32 &&
                offsetof(shared::ReferencePath, bounces) == 12 &&
                offsetof(shared::ReferencePath, density) == 28);
  const Records records(paths, index, sizeof(shared::ReferencePath) / 4);
  const Float4 front = records.four(0), back = records.four(4);
  return {{front.x, front.y, front.z},
          to_float(as_integer(front.w)),
          back.x,
          back.y,
          as_integer(back.z),
          back.w};
}

HWY_INLINE void store_paths(const PathLanes& path, Mask requested, Integer index,
                            shared::ReferencePath* paths) {
  const Texels<4> front(Float4{path.throughput.x, path.throughput.y, path.throughput.z,
                               as_float(truncated(path.bounces))});
  const Texels<4> back(
      Float4{path.cone_width, path.cone_spread, as_float(path.flags), path.density});
  const LaneIndices<Tag> at(index);
  for_each_lane(requested, [&](std::size_t lane) {
    auto* const to = reinterpret_cast<std::byte*>(paths + at.of[lane]);
    std::memcpy(to, &front.values[4 * lane], 16);
    std::memcpy(to + 16, &back.values[4 * lane], 16);
  });
}

/// Numbers in [0, 1) of one round for each purpose: path_number() and path_pair() of
/// shaders/lib/rays/reference_path.glsl, whose dimensions they have.
class PathNumbers {
  struct Position {
    const shared::FrameConstants& frame;
    std::uint32_t dimension;
  };
  struct Single {
    RandomNumbers<UnsignedTag> of;
    explicit Single(const Position& p)
        : of(unsigned_tag, p.frame.sample_index, p.dimension, p.frame.seed) {}
    HWY_INLINE Float at(const PixelLanes& p) const {
      return of.at(as_unsigned(p.x), as_unsigned(p.y));
    }
  };
  struct Pairs {
    RandomPairs<UnsignedTag> of;
    explicit Pairs(const Position& p)
        : of(unsigned_tag, p.frame.sample_index, p.dimension, p.frame.seed) {}
    HWY_INLINE Float2 at(const PixelLanes& p) const {
      Float2 pair;
      of.at(as_unsigned(p.x), as_unsigned(p.y), pair.x, pair.y);
      return pair;
    }
  };

 public:
  PathNumbers(const shared::FrameConstants& frame, std::uint32_t round)
      : PathNumbers(Position{frame, 256u + 16u * round}) {}

  Single passing, light, lobe, survival, band;
  Pairs light_point, direction, sky_cell, sky_point, triangle, triangle_point;

 private:
  static Position of(const Position& first, std::uint32_t which) {
    return {first.frame, first.dimension + which};
  }
  explicit PathNumbers(const Position& first)
      : passing(of(first, 0)),
        light(of(first, 1)),
        lobe(of(first, 3)),
        survival(of(first, 5)),
        band(of(first, 10)),
        light_point(of(first, 2)),
        direction(of(first, 4)),
        sky_cell(of(first, 6)),
        sky_point(of(first, 7)),
        triangle(of(first, 8)),
        triangle_point(of(first, 9)) {}
};

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
