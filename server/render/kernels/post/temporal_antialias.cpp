#include "render/kernels/post/temporal_antialias.hpp"

#include <algorithm>
#include <cmath>

#include "render/kernels/simd/rows.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/post/temporal_antialias.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/simd/history.hpp"
#include "render/kernels/simd/view.hpp"
#include "render/kernels/simd/window.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

// As in temporal_antialias.comp.
constexpr float min_anti_flicker = 0.2f;
constexpr float edge_depth = 0.05f;
constexpr float cubic_slope = -0.75f;
constexpr float most_still = 4.0f;
constexpr float off_texel_slope = 8.0f;
constexpr float distance_falloff = 2.0f;
constexpr float scaled_box = 1.3f;

template <class D>
class Antialiasing {
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;
  using DI = hn::RebindToSigned<D>;
  using VI = hn::Vec<DI>;

  static constexpr float far_away = 1e30f;  // view Z of the background among neighbours

  struct Box {
    Triple<V> low, high;
  };
  /// Channels of what lies around each pixel that was drawn.
  enum Around { box_low, box_high = 3, moved_x = 6, moved_y, around_channels };

 public:
  HWY_INLINE explicit Antialiasing(const AntialiasJob& job)
      : job_(job),
        width_(static_cast<int>(job.constants.shown.x)),
        height_(static_cast<int>(job.constants.shown.y)),
        scaled_(width_ != job.width || height_ != job.height),
        scale_(glm::vec2(job.width, job.height) / glm::vec2(job.constants.shown)),
        bounds_(width_, height_) {
    const glm::vec4& unproject = job.frame.unproject;
    if (scaled_) {
      jitter_ = -0.5f * glm::vec2(unproject.z, unproject.w) / glm::vec2(unproject) *
                glm::vec2(job.width, job.height);
    }
  }

  /// Rows of the frame that is shown.
  HWY_INLINE void rows(int first, int last) const {
    const int low = drawn_row(first), high = drawn_row(last - 1) + 1;
    // Compressed colour, and motion with view Z, of the pixels and their neighbours.
    const BandScratch colors(3, job_.width, low, high, 1);
    const BandScratch motion(3, job_.width, low, high, 1);
    const BandScratch around(around_channels, job_.width, low, high, 0);
    for (int y = low - 1; y <= high; ++y) fill(colors, motion, y);
    const int lanes = static_cast<int>(hn::Lanes(d_));
    for (int y = low; y < high; ++y) {
      const ViewedRow<D> view(job_.frame, y);
      for (int x = 0; x < job_.width; x += lanes) {
        look_around(colors, motion, view, std::min(x, job_.width - lanes), y, around);
      }
    }
    for (int y = first; y < last; ++y) {
      for (int x = 0; x < width_; x += lanes) {
        block(colors, around, std::min(x, width_ - lanes), y);
      }
    }
  }

 private:
  HWY_INLINE V set(float value) const { return hn::Set(d_, value); }

  /// Of the sample nearest to a row that is shown.
  HWY_INLINE int drawn_row(int y) const {
    if (!scaled_) return y;
    const float at = (static_cast<float>(y) + 0.5f) * scale_.y + jitter_.y;
    return std::clamp(static_cast<int>(std::floor(at)), 0, job_.height - 1);
  }

  HWY_INLINE void fill(const BandScratch& colors, const BandScratch& motion, int y) const {
    const int from = std::clamp(y, 0, job_.height - 1);
    const int lanes = static_cast<int>(hn::Lanes(d_));
    for (int i = 0; i < job_.width; i += lanes) {
      const int x = std::min(i, job_.width - lanes);
      const Quad<V> radiance = load4(d_, row_of<const float>(job_.radiance, from) + 4 * x);
      const Triple<V> c = compressed({radiance.x, radiance.y, radiance.z});
      hn::StoreU(c.x, d_, colors.row(0, y) + x);
      hn::StoreU(c.y, d_, colors.row(1, y) + x);
      hn::StoreU(c.z, d_, colors.row(2, y) + x);
      const Quad<V> moved = load4(d_, row_of<const float>(job_.motion, from) + 4 * x);
      const M seen = hn::Gt(moved.w, hn::Zero(d_));
      hn::StoreU(moved.x, d_, motion.row(0, y) + x);
      hn::StoreU(moved.y, d_, motion.row(1, y) + x);
      hn::StoreU(hn::IfThenElse(seen, moved.w, set(far_away)), d_, motion.row(2, y) + x);
    }
    for (int channel = 0; channel < 3; ++channel) {
      colors.extend(channel, y);
      motion.extend(channel, y);
    }
  }

  HWY_INLINE Triple<V> load(const BandScratch& scratch, int x, int y) const {
    return {hn::LoadU(d_, scratch.row(0, y) + x), hn::LoadU(d_, scratch.row(1, y) + x),
            hn::LoadU(d_, scratch.row(2, y) + x)};
  }

  HWY_INLINE Triple<V> compressed(const Triple<V>& radiance) const {
    const Triple<V> c = radiance * set(job_.exposure->factor);
    const V quarter = set(0.25f), half = set(0.5f);
    const V luma = hn::MulAdd(c.x, quarter, hn::MulAdd(c.y, half, c.z * quarter));
    const V green = hn::MulSub(c.y, half, (c.x + c.z) * quarter);
    const V orange = (c.x - c.z) * half;
    return Triple<V>{luma, green, orange} * (set(1.0f) / (set(1.0f) + luma));
  }

  HWY_INLINE Triple<V> expanded(const Triple<V>& c) const {
    const V zero = hn::Zero(d_);
    const Triple<V> shown = c * (set(1.0f) / hn::Max(set(1.0f) - c.x, set(1e-6f)));
    const V base = shown.x - shown.y;
    const V factor = set(1.0f / job_.exposure->factor);
    return Triple<V>{hn::Max(base + shown.z, zero), hn::Max(shown.x + shown.y, zero),
                     hn::Max(base - shown.z, zero)} *
           factor;
  }

  /// Motion of the background under the camera's rotation; to the previous frame, in uv.
  HWY_INLINE Pair<V> background_motion(const ViewedRow<D>& view, int x) const {
    if (job_.frame.flags & shared::frame_orthographic) return {hn::Zero(d_), hn::Zero(d_)};
    const Triple<V> eye = view.to_eye(x);
    const Triple<V> before = directed(job_.frame.previous_unjittered, eye);
    const Triple<V> now = directed(job_.frame.unjittered, eye);
    const V half = set(0.5f);
    // Directions behind the camera have no position in the frame.
    const M ahead = hn::Gt(before.z, hn::Zero(d_));
    return {hn::IfThenElse(ahead, (before.x / before.z - now.x / now.z) * half, set(2.0f)),
            hn::IfThenElse(ahead, (before.y / before.z - now.y / now.z) * half, set(2.0f))};
  }

  /// x, y and w of `matrix` x (-eye, 0).
  HWY_INLINE Triple<V> directed(const glm::mat4& matrix, const Triple<V>& eye) const {
    const glm::mat4 m = -matrix;
    return {dot(splat(d_, {m[0].x, m[1].x, m[2].x}), eye),
            dot(splat(d_, {m[0].y, m[1].y, m[2].y}), eye),
            dot(splat(d_, {m[0].w, m[1].w, m[2].w}), eye)};
  }

  /// Motion of the nearest surface of 3x3 pixels: an edge moves with what lies in front. Elsewhere
  /// that of the pixel itself: its neighbours on the same surface move by more or less.
  HWY_INLINE Pair<V> edge_motion(const BandScratch& motion, const ViewedRow<D>& view, int x,
                                 int y) const {
    const Triple<V> own = load(motion, x, y);
    Triple<V> nearest = own;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const Triple<V> candidate = load(motion, x + dx, y + dy);
        nearest = select(hn::Lt(candidate.z, nearest.z), candidate, nearest);
      }
    }
    const M edge = hn::Gt(own.z - nearest.z, set(edge_depth) * nearest.z);
    const Triple<V> chosen = select(edge, nearest, own);
    const M seen = hn::Lt(nearest.z, set(far_away));
    if (hn::AllTrue(d_, seen)) return {chosen.x, chosen.y};
    const Pair<V> behind = background_motion(view, x);
    return {hn::IfThenElse(seen, chosen.x, behind.x), hn::IfThenElse(seen, chosen.y, behind.y)};
  }

  /// Of four texels in a row for a point at fraction `f` between the second and the third.
  struct Weights {
    V w[4];
    HWY_INLINE explicit Weights(V f) {
      const V one = hn::Set(D(), 1.0f);
      w[0] = far(one + f);
      w[1] = near(f);
      w[2] = near(one - f);
      w[3] = far(hn::Set(D(), 2.0f) - f);
    }

   private:
    static HWY_INLINE V near(V x) {
      const V steep =
          hn::MulSub(hn::Set(D(), cubic_slope + 2.0f), x, hn::Set(D(), cubic_slope + 3.0f));
      return hn::MulAdd(steep, x * x, hn::Set(D(), 1.0f));
    }
    static HWY_INLINE V far(V x) {
      const V inner = hn::MulAdd(x - hn::Set(D(), 5.0f), x, hn::Set(D(), 8.0f));
      return hn::Set(D(), cubic_slope) * hn::MulSub(inner, x, hn::Set(D(), 4.0f));
    }
  };

  /// How far from a texel the history is read, 0 (there) to 0.5, along the farther axis.
  HWY_INLINE V off_texel(V u, V v) const {
    const auto off = [&](V t, int size) HWY_ATTR {
      const V at = t * set(static_cast<float>(size));
      return hn::Abs(at - hn::Floor(at) - set(0.5f));
    };
    return hn::Max(off(u, width_), off(v, height_));
  }

  /// May overshoot; w: of the nearest texel.
  HWY_INLINE Quad<V> sample_history(V u, V v) const {
    const V half = set(0.5f);
    const V x = hn::MulSub(u, set(static_cast<float>(width_)), half);
    const V y = hn::MulSub(v, set(static_cast<float>(height_)), half);
    const V low_x = hn::Floor(x), low_y = hn::Floor(y);
    const V fx = x - low_x, fy = y - low_y;
    const Weights across(fx), down(fy);
    const VI column = hn::ConvertTo(di_, low_x), row = hn::ConvertTo(di_, low_y);
    const V zero = hn::Zero(d_);
    Triple<V> sum{zero, zero, zero};
    if (!sum_of_window(column, row, across, down, sum)) {
      for (int j = 0; j < 4; ++j) {
        Triple<V> line{zero, zero, zero};
        for (int i = 0; i < 4; ++i) {
          const TexelGather<D> texels =
              bounds_.gather(column + hn::Set(di_, i - 1), row + hn::Set(di_, j - 1));
          line = line + texels.first_three(job_.history) * across.w[i];
        }
        sum = sum + line * down.w[j];
      }
    }
    const auto next = [&](V f) HWY_ATTR {
      const V step = hn::IfThenElseZero(hn::Ge(f, half), set(1.0f));
      return hn::ConvertTo(di_, step);
    };
    const V frames = bounds_.gather(column + next(fx), row + next(fy)).last_of_four(job_.history);
    return {hn::Max(sum.x, zero), hn::Max(sum.y, zero), hn::Max(sum.z, zero), frames};
  }

  /// The same where the lanes lie near each other, in the same row or the next. @return whether
  HWY_INLINE bool sum_of_window(VI column, VI row, const Weights& across, const Weights& down,
                                Triple<V>& sum) const {
    if constexpr (hn::MaxLanes(D()) == 1) return false;
    const int top = hn::GetLane(hn::MinOfLanes(di_, row));
    const int rows = hn::GetLane(hn::MaxOfLanes(di_, row)) - top;
    const ColumnWindow<D> window(column, 1, 2, width_);
    if (rows > 1 || !window.fits()) return false;
    const V zero = hn::Zero(d_);
    const M lower = hn::RebindMask(d_, hn::Gt(row, hn::Set(di_, top)));
    const typename ColumnWindow<D>::Pick picks[4]{window.pick(-1), window.pick(0), window.pick(1),
                                                  window.pick(2)};
    for (int j = 0; j < 4 + rows; ++j) {
      const int y = std::clamp(top + j - 1, 0, height_ - 1);
      const auto texels = window.load(row_of<const float>(job_.history, y));
      Triple<V> line{zero, zero, zero};
      for (int i = 0; i < 4; ++i) line = line + window.texels(texels, picks[i]) * across.w[i];
      const V upper_weight = j < 4 ? down.w[j] : zero;
      const V lower_weight = j > 0 ? down.w[j - 1] : zero;
      sum = sum + line * hn::IfThenElse(lower, lower_weight, upper_weight);
    }
    return true;
  }

  /// Mean and deviation of the 3x3 neighbours.
  HWY_INLINE Box box_about(const BandScratch& colors, int x, int y) const {
    const V zero = hn::Zero(d_), ninth = set(1.0f / 9.0f);
    Triple<V> mean{zero, zero, zero};
    for (int i = 0; i < 9; ++i) mean = mean + load(colors, x + i % 3 - 1, y + i / 3 - 1);
    mean = mean * ninth;
    // About the mean, not as a difference of squares: compressed highlights hardly differ.
    Triple<V> variance{zero, zero, zero};
    for (int i = 0; i < 9; ++i) {
      const Triple<V> off = load(colors, x + i % 3 - 1, y + i / 3 - 1) - mean;
      variance = variance + off * off;
    }
    variance = variance * ninth;
    const Triple<V> deviation{hn::Sqrt(variance.x), hn::Sqrt(variance.y), hn::Sqrt(variance.z)};
    const Triple<V> half_extent =
        deviation * set(scaled_ ? scaled_box * job_.constants.clip : job_.constants.clip);
    return {mean - half_extent, mean + half_extent};
  }

  HWY_INLINE void look_around(const BandScratch& colors, const BandScratch& motion,
                              const ViewedRow<D>& view, int x, int y,
                              const BandScratch& around) const {
    const Box box = box_about(colors, x, y);
    const Pair<V> moved = edge_motion(motion, view, x, y);
    const V channels[around_channels]{box.low.x,  box.low.y,  box.low.z, box.high.x,
                                      box.high.y, box.high.z, moved.x,   moved.y};
    for (int i = 0; i < around_channels; ++i) hn::StoreU(channels[i], d_, around.row(i, y) + x);
  }

  /// The samples nearest to pixels that are shown.
  struct Nearest {
    int x, row;  // of the first, where frames are drawn at the size that is shown
    VI column;
    V weight;  // 1 at the centre of the pixel
  };
  HWY_INLINE Nearest nearest_samples(int x, int y) const {
    const V one = set(1.0f);
    if (!scaled_) return {x, y, hn::Zero(di_), one};
    const V center = hn::Iota(d_, static_cast<float>(x) + 0.5f) * set(scale_.x);
    const V last = set(static_cast<float>(job_.width - 1));
    const V at = hn::Min(hn::Max(hn::Floor(center + set(jitter_.x)), hn::Zero(d_)), last);
    const int row = drawn_row(y);
    const V off_x = (at + set(0.5f - jitter_.x) - center) * set(1.0f / scale_.x);
    const float center_y = (static_cast<float>(y) + 0.5f) * scale_.y;
    const float off_y = (static_cast<float>(row) + 0.5f - jitter_.y - center_y) / scale_.y;
    const V far = hn::MulAdd(off_x, off_x, set(off_y * off_y)) * set(distance_falloff);
    const V weight = one / hn::MulAdd(far, hn::MulAdd(far, set(0.5f), one), one);
    return {x, row, hn::ConvertTo(di_, at), weight};
  }
  HWY_INLINE V read(const BandScratch& scratch, int channel, const Nearest& at) const {
    const float* const row = scratch.row(channel, at.row);
    return scaled_ ? hn::GatherIndex(d_, row, at.column) : hn::LoadU(d_, row + at.x);
  }
  HWY_INLINE Triple<V> read_three(const BandScratch& scratch, int channel,
                                  const Nearest& at) const {
    return {read(scratch, channel, at), read(scratch, channel + 1, at),
            read(scratch, channel + 2, at)};
  }
  HWY_INLINE Triple<V> radiance(const Nearest& at) const {
    const float* const row = row_of<const float>(job_.radiance, at.row);
    if (scaled_) return gather3(d_, row, hn::ShiftLeft<2>(at.column));
    const Quad<V> t = load4(d_, row + 4 * at.x);
    return {t.x, t.y, t.z};
  }

  HWY_INLINE void block(const BandScratch& colors, const BandScratch& around, int x, int y) const {
    const V zero = hn::Zero(d_), one = set(1.0f);
    float* const out = row_of<float>(job_.resolved, y) + 4 * x;
    const Nearest nearest = nearest_samples(x, y);
    const V u = hn::Iota(d_, static_cast<float>(x) + 0.5f) / set(static_cast<float>(width_)) +
                read(around, moved_x, nearest);
    const V v = set((static_cast<float>(y) + 0.5f) / static_cast<float>(height_)) +
                read(around, moved_y, nearest);
    // There is no history outside the frame.
    M known =
        hn::And(hn::And(hn::Ge(u, zero), hn::Le(u, one)), hn::And(hn::Ge(v, zero), hn::Le(v, one)));
    const Triple<V> alone = radiance(nearest);
    const Quad<V> first{alone.x, alone.y, alone.z, nearest.weight};
    if (job_.frame.history_invalid != 0 || hn::AllFalse(d_, known)) {
      store4(d_, first, out);
      return;
    }
    const Box box{read_three(around, box_low, nearest), read_three(around, box_high, nearest)};
    const Quad<V> found = sample_history(clamped(u, 0.0f, 1.0f), clamped(v, 0.0f, 1.0f));
    const Triple<V> old = compressed({found.x, found.y, found.z});
    const V still = hn::Max(hn::NegMulAdd(set(off_texel_slope), off_texel(u, v), one), zero);
    const float most_moving = (1.0f / job_.constants.blend - 1.0f) * scale_.x * scale_.y;
    const V most = hn::MulAdd(still, set(most_still - 1.0f), one) * set(most_moving);
    const V samples = hn::Min(found.w, most) + nearest.weight;
    V weight = nearest.weight / samples;
    if (job_.constants.anti_flicker > 0.0f) {
      const V margin = hn::Min(hn::Abs(old.x - box.low.x), hn::Abs(box.high.x - old.x));
      const V span = hn::Max(margin + box.high.x - box.low.x, set(1e-6f));
      weight = weight * hn::Max(margin / span, set(min_anti_flicker));
    }
    const Triple<V> held{hn::Min(hn::Max(old.x, box.low.x), box.high.x),
                         hn::Min(hn::Max(old.y, box.low.y), box.high.y),
                         hn::Min(hn::Max(old.z, box.low.z), box.high.z)};
    const Triple<V> result = expanded(mix(held, read_three(colors, 0, nearest), weight));
    store4(d_, select(known, Quad<V>{result.x, result.y, result.z, samples}, first), out);
  }

  const D d_{};
  const DI di_{};
  const AntialiasJob& job_;
  int width_, height_;  // of what is shown
  bool scaled_;
  glm::vec2 scale_;  // of what is drawn
  glm::vec2 jitter_{0.0f};
  Bounds<D> bounds_;
};

void antialias_rows(const AntialiasJob& job, int first, int last) {
  run_rows<Antialiasing>(job, job.width, first, last);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(antialias_rows);

namespace {

/// The history as it is.
void copy_rows(const AntialiasJob& job, int first, int last) {
  const std::size_t floats = 4 * std::size_t{job.constants.shown.x};
  for (int y = first; y < last; ++y) {
    const auto row = static_cast<std::uint32_t>(y);
    std::copy_n(job.history.row<const float>(row), floats, job.resolved.row<float>(row));
  }
}

}  // namespace

void temporal_antialias(const AntialiasJob& job) {
  for_each_band(static_cast<int>(job.constants.shown.y), [&](int first, int last) {
    if (job.constants.hold) return copy_rows(job, first, last);
    HWY_DYNAMIC_DISPATCH(antialias_rows)(job, first, last);
  });
}

}  // namespace heliograph::render::kernels
#endif
