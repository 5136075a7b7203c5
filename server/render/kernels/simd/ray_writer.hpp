// Streams of rays, a lane for every ray. Included once per instruction set.
#if defined(HELIOGRAPH_KERNELS_RAY_WRITER_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_RAY_WRITER_HPP
#undef HELIOGRAPH_KERNELS_RAY_WRITER_HPP
#else
#define HELIOGRAPH_KERNELS_RAY_WRITER_HPP
#endif

#include <array>
#include <cstring>

#include "render/kernels/common/ray_sink.hpp"
#include "render/kernels/simd/lanes.hpp"
#include "shaders/shared/frame_constants.h"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

struct PixelLanes {
  Integer x, y;
};

struct RayLanes {
  Float3 origin, direction;
  Float t_min, t_max;
  Integer pixel;  // x | y << 16
  Float3 user;    // `user` and both paddings
};

HWY_INLINE Integer pack_pixel(const PixelLanes& p) {
  return hn::Or(p.x, hn::ShiftLeft<16>(p.y));
}
HWY_INLINE PixelLanes unpack_pixel(Integer packed) {
  const Unsigned bits = as_unsigned(packed);
  return {hn::And(packed, integer(0xffff)), as_integer(hn::ShiftRight<16>(bits))};
}

/// Words `word` to `word` + 3 of the records from `first` on; lanes from `last` on have the last.
template <class Record>
HWY_INLINE Float4 records_in_order(const Record* records, int word, int first, int last) {
  return four_words(tag, [=](std::size_t lane) {
    const int index = std::min(first + static_cast<int>(lane), last - 1);
    return reinterpret_cast<const float*>(records + index) + word;
  });
}

/// The rays from `first` on; lanes from `last` on have the last.
HWY_INLINE RayLanes load_rays(const shared::Ray* rays, int first, int last) {
  const Float4 a = records_in_order(rays, 0, first, last);
  const Float4 b = records_in_order(rays, 4, first, last);
  const Float4 c = records_in_order(rays, 8, first, last);
  return {{a.x, a.y, a.z}, {b.x, b.y, b.z}, a.w, b.w, as_integer(c.x), {c.y, c.z, c.w}};
}

/// Writes the rays of the lanes in `wanted`, one after the other. @return how many
HWY_INLINE std::size_t store_rays(const RayLanes& r, Mask requested, shared::Ray* to) {
  constexpr std::size_t most = 4 * hn::MaxLanes(Tag());
  HWY_ALIGN std::array<float, most> first, second, third;
  hn::StoreInterleaved4(r.origin.x, r.origin.y, r.origin.z, r.t_min, tag, first.data());
  hn::StoreInterleaved4(r.direction.x, r.direction.y, r.direction.z, r.t_max, tag, second.data());
  hn::StoreInterleaved4(as_float(r.pixel), r.user.x, r.user.y, r.user.z, tag, third.data());
  std::uint64_t lanes = mask_bits(requested);
  std::size_t count = 0;
  for (; lanes; lanes &= lanes - 1) {
    const auto lane = static_cast<std::size_t>(__builtin_ctzll(lanes));
    auto* const out = reinterpret_cast<std::byte*>(to + count++);
    std::memcpy(out, &first[4 * lane], 16);
    std::memcpy(out + 16, &second[4 * lane], 16);
    std::memcpy(out + 32, &third[4 * lane], 16);
  }
  return count;
}

/// Rays of a tile or a batch on their way into a stream.
class RayBatch {
 public:
  HWY_INLINE void add(const RayLanes& lanes, Mask requested) {
    count_ += store_rays(lanes, requested, rays_.data() + count_);
  }
  void append_to(const RaySink<gpu::Mapped>& sink) const {
    if (count_) sink.append({rays_.data(), count_});
  }

 private:
  std::array<shared::Ray, ray_batch> rays_;
  std::size_t count_ = 0;
};

/// Calls `work(lane)` for every lane in `wanted`.
template <class Work>
HWY_INLINE void for_each_lane(Mask requested, const Work& work) {
  for (std::uint64_t lanes = mask_bits(requested); lanes; lanes &= lanes - 1) {
    work(static_cast<std::size_t>(__builtin_ctzll(lanes)));
  }
}

/// Pixels lane by lane.
struct TexelIndices {
  HWY_ALIGN std::array<int, hn::MaxLanes(Tag())> x, y;
  HWY_INLINE explicit TexelIndices(const PixelLanes& p) {
    hn::Store(p.x, integer_tag, x.data());
    hn::Store(p.y, integer_tag, y.data());
  }
};

/// Neighbours in rows of tiles of 8 x 8.
inline constexpr std::size_t tile_run = std::min<std::size_t>(hn::MaxLanes(Tag()), 8);

/// Calls `work(lane, count)` for all lanes in `requested`, for whole runs of pixels side by side at
/// once.
template <class Work>
HWY_INLINE void for_each_run(Mask requested, const PixelLanes& p, const Work& work) {
  constexpr std::uint64_t whole_run = (1ull << tile_run) - 1;
  const Integer before = hn::And(hn::Iota(integer_tag, 0), integer(static_cast<int>(tile_run) - 1));
  const Integer first = hn::Sub(p.x, before);
  HWY_ALIGN std::array<int, hn::MaxLanes(Tag())> starts, rows;
  hn::Store(first, integer_tag, starts.data());
  hn::Store(p.y, integer_tag, rows.data());
  std::uint64_t beside = 0;
  for (std::size_t run = 0; run < hn::MaxLanes(Tag()); run += tile_run) {
    const Integer x = integer(starts[run]), y = integer(rows[run]);
    const Mask same = float_mask(hn::And(hn::Eq(first, x), hn::Eq(p.y, y)));
    beside |= mask_bits(same) & whole_run << run;
  }
  std::uint64_t lanes = mask_bits(requested);
  for (std::size_t run = 0; run < hn::MaxLanes(Tag()); run += tile_run) {
    const std::uint64_t all = whole_run << run;
    if ((lanes & beside & all) != all) continue;
    work(run, tile_run);
    lanes &= ~all;
  }
  for (; lanes; lanes &= lanes - 1) {
    work(static_cast<std::size_t>(__builtin_ctzll(lanes)), std::size_t{1});
  }
}

/// Texels of `words` words lane by lane, on their way into an image.
template <int words>
struct Texels {
  HWY_ALIGN std::array<float, words * hn::MaxLanes(Tag())> values;
  HWY_INLINE explicit Texels(Float v) { hn::Store(v, tag, values.data()); }
  HWY_INLINE explicit Texels(const Float2& v) {
    hn::StoreInterleaved2(v.x, v.y, tag, values.data());
  }
  HWY_INLINE explicit Texels(const Float4& v) {
    hn::StoreInterleaved4(v.x, v.y, v.z, v.w, tag, values.data());
  }
  HWY_INLINE void put(const gpu::HostView& image, std::size_t lane, const TexelIndices& at) const {
    put(image, lane, 1, at);
  }
  /// Of `count` lanes, pixels side by side: 1 or tile_run.
  HWY_INLINE void put(const gpu::HostView& image, std::size_t lane, std::size_t count,
                      const TexelIndices& at) const {
    float* const row = image.row<float>(static_cast<std::uint32_t>(at.y[lane]));
    const float* const from = values.data() + words * lane;
    if (count == tile_run) {
      std::memcpy(row + words * at.x[lane], from, tile_run * words * sizeof(float));
    } else {
      std::memcpy(row + words * at.x[lane], from, words * sizeof(float));
    }
  }
};

/// The frame's camera, as shaders/lib/frame.glsl has it.
class CameraLanes {
 public:
  explicit CameraLanes(const shared::FrameConstants& frame)
      : frame_(frame),
        orthographic_((frame.flags & shared::frame_orthographic) != 0),
        scale_(2.0f / glm::vec2(frame.extent)) {}

  bool orthographic() const { return orthographic_; }

  /// View xy of the sample `away` pixels from those at p, at view Z 1 where the view widens.
  HWY_INLINE Float2 slope(const PixelLanes& p, float away_x = 0.5f, float away_y = 0.5f) const {
    const glm::vec4& u = frame_.unproject;
    const Float x = hn::MulSub(hn::Add(to_float(p.x), number(away_x)), number(scale_.x), one());
    const Float y = hn::MulSub(hn::Add(to_float(p.y), number(away_y)), number(scale_.y), one());
    return {hn::MulAdd(x, number(u.x), number(u.z)), hn::MulAdd(y, number(u.y), number(u.w))};
  }
  HWY_INLINE Float3 view_position(const PixelLanes& p, Float view_z) const {
    const Float2 s = slope(p);
    if (orthographic_) return {s.x, s.y, hn::Neg(view_z)};
    return {hn::Mul(s.x, view_z), hn::Mul(s.y, view_z), hn::Neg(view_z)};
  }
  HWY_INLINE Float3 world_position(const PixelLanes& p, Float view_z) const {
    return transform_point(frame_.inverse_view, view_position(p, view_z));
  }
  /// Unit vector from the surface toward the eye, world space.
  HWY_INLINE Float3 to_eye(const PixelLanes& p) const {
    if (orthographic_) return normalized(numbers(glm::vec3(frame_.inverse_view[2])));
    return normalized(transform_direction(frame_.inverse_view, -view_position(p, one())));
  }
  /// The cone of textures that rays through the middles of pixels see: footprint at the start and
  /// per metre.
  glm::vec2 cone() const {
    const float pixel = 2.0f * std::abs(frame_.unproject.y) * frame_.texture_footprint /
                        static_cast<float>(frame_.extent.y);
    return orthographic_ ? glm::vec2(pixel, 0.0f) : glm::vec2(0.0f, pixel);
  }

 private:
  const shared::FrameConstants& frame_;
  bool orthographic_;
  glm::vec2 scale_;
};

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
