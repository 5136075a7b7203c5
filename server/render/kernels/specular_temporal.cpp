#include "render/kernels/common/row_ring.hpp"
#include "render/kernels/simd/rows.hpp"
#include "render/kernels/temporal.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/specular_temporal.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "hwy/contrib/math/math-inl.h"
#include "render/kernels/simd/denoise/history_reader.hpp"
#include "render/kernels/simd/edge_stopping.hpp"
#include "render/kernels/simd/guide.hpp"
#include "render/kernels/simd/moments.hpp"
#include "render/kernels/simd/view.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

template <class D>
class SpecularAccumulation {
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;
  using DI = hn::RebindToSigned<D>;
  using VI = hn::Vec<DI>;

  static constexpr float no_hit = 1e9f;
  /// Of a row and its neighbours: unit normal and position in the world, instance as bits.
  enum Plane { normal, position = 3, radiance = 6, roughness = 9, view_z, instance, hit, planes };

  struct HistorySample {
    Triple<V> radiance;
    V frames;  // 0: nothing
    Pair<V> moments;
    Triple<V> fast;
  };
  using Surface = Guide<V>;

 public:
  HWY_INLINE explicit SpecularAccumulation(const TemporalSpecularJob& job)
      : job_(job), c_(job.constants), bounds_(job.width, job.height) {}

  HWY_INLINE void rows(int first, int last) const {
    const RowRing ring(planes, job_.width, 1, 3);
    int next = std::max(first - 1, 0);
    const int lanes = static_cast<int>(hn::Lanes(d_));
    for (int y = first; y < last; ++y) {
      for (; next <= std::min(y + 1, job_.height - 1); ++next) fill(ring, next);
      const ViewedRow<D> view(job_.frame, y);
      for (int x = 0; x < job_.width; x += lanes) {
        block(ring, view, std::min(x, job_.width - lanes), y);
      }
    }
  }

 private:
  HWY_INLINE V set(float value) const { return hn::Set(d_, value); }
  HWY_INLINE Quad<V> load(const gpu::HostView& image, int x, int y) const {
    return load4(d_, row_of<const float>(image, y) + 4 * x);
  }

  HWY_INLINE V plane(const RowRing& ring, int y, int index, int x) const {
    return hn::LoadU(d_, ring.row(y) + index * ring.pitch() + x);
  }
  HWY_INLINE Triple<V> three_planes(const RowRing& ring, int y, int first, int x) const {
    return {plane(ring, y, first, x), plane(ring, y, first + 1, x), plane(ring, y, first + 2, x)};
  }

  /// Takes a row apart; `no_hit` where the hit distance is not to be known.
  HWY_INLINE void fill(const RowRing& ring, int y) const {
    const ViewedRow<D> view(job_.frame, y);
    float* const row = ring.row(y);
    const int lanes = static_cast<int>(hn::Lanes(d_));
    for (int i = 0; i < job_.width; i += lanes) {
      const int x = std::min(i, job_.width - lanes);
      const auto store = [&](int index, V v)
                             HWY_ATTR { hn::StoreU(v, d_, row + index * ring.pitch() + x); };
      const auto store3 = [&](int index, const Triple<V>& v) HWY_ATTR {
        store(index, v.x);
        store(index + 1, v.y);
        store(index + 2, v.z);
      };
      const Surface s = decode_guide(load(job_.guide, x, y));
      store3(normal, s.normal);
      store3(position, view.world_position(x, s.view_z));
      store(roughness, s.roughness);
      store(view_z, s.view_z);
      const VI id = hn::LoadU(di_, row_of<const int>(job_.instance, y) + x);
      store(instance, hn::BitCast(d_, id));
      const Quad<V> sample = load(job_.noisy, x, y);
      const Triple<V> now{sample.x, sample.y, sample.z};
      const V zero = hn::Zero(d_);
      store3(radiance, select(is_bad(now), Triple<V>{zero, zero, zero}, now));
      // Where no sample was taken the distance is that of the frame before, negated.
      const V distance = hn::Abs(sample.w);
      const M known = hn::AndNot(is_bad(distance), hn::Gt(distance, zero));
      store(hit, hn::IfThenElse(known, distance, set(no_hit)));
    }
    float* const hits = row + hit * ring.pitch();
    hits[-1] = hits[job_.width] = no_hit;
  }

  /// The shortest of the neighbours' hit distances.
  HWY_INLINE V hit_distance(const RowRing& ring, int x, int y) const {
    V nearest = set(no_hit);
    for (int row = std::max(y - 1, 0); row <= std::min(y + 1, job_.height - 1); ++row) {
      for (int i = -1; i <= 1; ++i) nearest = hn::Min(nearest, plane(ring, row, hit, x + i));
    }
    return hn::IfThenElseZero(hn::Lt(nearest, set(no_hit)), nearest);
  }

  HWY_INLINE V specular_dominant_factor(V roughness) const {
    const V smooth_part = set(1.0f) - roughness;
    return clamped(smooth_part * (hn::Sqrt(smooth_part) + roughness), 0.0f, 1.0f);
  }

  HWY_INLINE Pair<V> projected(const glm::mat4& m, const Triple<V>& p) const {
    const V w = hn::MulAdd(set(m[0].w), p.x,
                           hn::MulAdd(set(m[1].w), p.y, hn::MulAdd(set(m[2].w), p.z, set(m[3].w))));
    const V half = set(0.5f) / w;
    const Triple<V> clip = transformed(m, p);
    return {clip.x * half, clip.y * half};
  }

  HWY_INLINE V virtual_distance(V distance, V curvature) const {
    return distance / hn::Max(hn::MulAdd(set(2.0f) * curvature, distance, set(1.0f)),
                              set(shared::virtual_distance_min_divisor));
  }

  /// Change of a reflector's normal along the surface, positive for convex, and from pixel to
  /// pixel.
  struct Curvature {
    V curvature;
    V normal_change;
  };

  HWY_INLINE Curvature local_curvature(const RowRing& ring, int x, int y, const Surface& s,
                                       const Triple<V>& here) const {
    const V zero = hn::Zero(d_);
    if ((c_.flags & shared::temporal_curved_reflectors) == 0) return {zero, zero};
    const VI own = hn::BitCast(di_, plane(ring, y, instance, x));
    V curvature = zero, normal_changes = zero, count = zero;
    for (int i = 0; i < 4; ++i) {
      const int column = x + (i < 2 ? 2 * i - 1 : 0), row = y + (i < 2 ? 0 : 2 * i - 5);
      if (row < 0 || row >= job_.height) continue;
      const VI there = hn::BitCast(di_, plane(ring, row, instance, column));
      const M same = hn::RebindMask(d_, hn::Eq(there, own));
      const M valid = hn::And(same, hn::Gt(plane(ring, row, view_z, column), zero));
      const Triple<V> step = three_planes(ring, row, position, column) - here;
      const Triple<V> normal_change = three_planes(ring, row, normal, column) - s.normal;
      const V along = dot(normal_change, step) * reciprocal(hn::Max(dot(step, step), set(1e-20f)));
      curvature = curvature + hn::IfThenElseZero(valid, along);
      normal_changes = normal_changes + hn::IfThenElseZero(valid, length(normal_change));
      count = count + hn::IfThenElseZero(valid, set(1.0f));
    }
    const V inv_count = set(1.0f) / hn::Max(count, set(1.0f));
    return {curvature * inv_count, normal_changes * inv_count};
  }

  HWY_INLINE Pair<V> motion_of(const Triple<V>& point) const {
    const Pair<V> before = projected(job_.frame.previous_unjittered, point);
    const Pair<V> now = projected(job_.frame.unjittered, point);
    return {(before.x - now.x) * set(static_cast<float>(job_.width)),
            (before.y - now.y) * set(static_cast<float>(job_.height))};
  }

  /// Motion of the virtual positions from this frame to the frame before, in pixels.
  HWY_INLINE Pair<V> virtual_motion(const RowRing& ring, const ViewedRow<D>& view, int x, int y,
                                    const Surface& s, const Triple<V>& here, V curvature) const {
    const Triple<V> eye = view.to_eye(x);
    const V far = hit_distance(ring, x, y), dominant_factor = specular_dominant_factor(s.roughness);
    const V cosine = clamped(dot(s.normal, eye), shared::reflector_min_cosine, 1.0f);
    const auto behind = [&](V along_curvature) HWY_ATTR {
      return motion_of(here - eye * (dominant_factor * virtual_distance(far, along_curvature)));
    };
    const Pair<V> within = behind(curvature / cosine);
    if (hn::AllTrue(d_, hn::Eq(curvature, hn::Zero(d_)))) return within;
    const Pair<V> across = behind(curvature * cosine);
    const glm::mat4& m = job_.frame.view;
    const auto turned = [&](int row, float sign) HWY_ATTR {
      const V along =
          hn::MulAdd(set(m[0][row]), s.normal.x,
                     hn::MulAdd(set(m[1][row]), s.normal.y, set(m[2][row]) * s.normal.z));
      return sign < 0.0f ? hn::Neg(along) : along;
    };
    const V px = turned(0, job_.frame.unproject.x), py = turned(1, job_.frame.unproject.y);
    const V length_sq = hn::Max(hn::MulAdd(px, px, py * py), set(1e-12f));
    const V along = hn::MulAdd(within.x - across.x, px, (within.y - across.y) * py) / length_sq;
    return {hn::MulAdd(px, along, across.x), hn::MulAdd(py, along, across.y)};
  }

  /// Whether the frame before shows the same reflector there.
  HWY_INLINE M same_reflector(VI x, VI y, M requested, VI own, const Surface& s,
                              V normal_change) const {
    const M candidates = hn::And(requested, bounds_.contain(x, y));
    if (hn::AllFalse(d_, candidates)) return candidates;
    const TexelGather<D> texels = bounds_.gather(x, y);
    const auto shown = hn::Eq(texels.word(job_.previous_instance), own);
    M same = hn::And(candidates, hn::RebindMask(d_, shown));
    const Pair<V> encoded = texels.first_two(job_.previous_normals);
    const V cosine = dot(octahedral_decode(encoded.x, encoded.y), s.normal);
    const V by_curvature = hn::NegMulAdd(set(2.0f) * normal_change, normal_change, set(1.0f));
    const V allowed = hn::Min(
        mix(set(shared::reflector_cosine_smooth), set(shared::reflector_cosine_rough), s.roughness),
        by_curvature);
    same = hn::And(same, hn::Gt(cosine, allowed));
    const auto texel = hn::BitCast(hn::RebindToUnsigned<D>(), texels.word(job_.previous_surface));
    const V off = hn::Abs(unorm8<0>(d_, texel) - s.roughness);
    return hn::And(
        same, hn::Lt(off, hn::MulAdd(set(shared::reflector_roughness_tolerance_relative),
                                     s.roughness, set(shared::reflector_roughness_tolerance))));
  }

  HWY_INLINE HistoryTaps<D> virtual_taps(V x, V y, M requested, VI own, const Surface& s,
                                         V normal_change) const {
    HistoryTaps<D> taps(x, y);
    for (int i = 0; i < 4; ++i) {
      const M weighs = hn::And(requested, hn::Gt(taps.weights[i], hn::Zero(d_)));
      const M same = same_reflector(taps.tap_x(i), taps.tap_y(i), weighs, own, s, normal_change);
      taps.keep(i, same);
    }
    taps.normalise();
    return taps;
  }

  HWY_INLINE HistorySample no_history() const {
    const V zero = hn::Zero(d_);
    return {{zero, zero, zero}, zero, {zero, zero}, {zero, zero, zero}};
  }

  HWY_INLINE HistorySample fetch_history(const HistoryTaps<D>& taps) const {
    const HistoryReader<D> reader(taps, job_.width, job_.height);
    const bool bicubic = (c_.flags & shared::temporal_bicubic) != 0;
    const Quad<V> signal = bicubic ? reader.template bicubic<Halves>(job_.previous_history)
                                   : reader.template bilinear<Halves>(job_.previous_history);
    const Quad<V> state = reader.template bilinear<MeanAndDeviation>(job_.previous_history_length);
    HistorySample r = no_history();
    r.radiance = {signal.x, signal.y, signal.z};
    r.frames = state.x;
    r.moments = {state.z, state.w};
    // The gradient compares with the long history alone.
    if (c_.rectification != shared::rectification_gradient) {
      const Quad<V> fast = reader.template bilinear<Halves>(job_.previous_fast_history);
      r.fast = {fast.x, fast.y, fast.z};
    }
    return r;
  }

  /// The history of the better candidate.
  HWY_INLINE HistorySample reprojected_history(const RowRing& ring, const ViewedRow<D>& view, int x,
                                               int y, M seen, const Surface& s) const {
    if ((c_.flags & shared::temporal_history_valid) == 0) return no_history();
    const Quad<V> map = load(job_.reprojection, x, y);
    const HistoryTaps<D> own = history_taps<D>(map);
    if ((c_.flags & shared::temporal_virtual_motion) == 0) return fetch_history(own);
    const Triple<V> here = three_planes(ring, y, position, x);
    const Curvature curvature = local_curvature(ring, x, y, s, here);
    const Pair<V> motion = virtual_motion(ring, view, x, y, s, here, curvature.curvature);
    const V here_x = hn::Iota(d_, static_cast<float>(x) + 0.5f);
    const V here_y = set(static_cast<float>(y) + 0.5f);
    const V separation_x = map.x - here_x - motion.x, separation_y = map.y - here_y - motion.y;
    const V separation =
        hn::Sqrt(hn::MulAdd(separation_x, separation_x, separation_y * separation_y));
    const V lobe = view.lobe_pixels(s.roughness);
    const V threshold = hn::Min((lobe + set(1.0f)) * set(shared::virtual_threshold_per_pixel),
                                set(shared::virtual_threshold_max));
    const M elsewhere = hn::And(seen, hn::Or(hn::Gt(separation, threshold), hn::Not(own.any())));
    // The history at the surface's position shows another part of the reflection, the more so the
    // smoother the reflector and the larger the separation.
    const V falloff = hn::MulAdd(set(shared::surface_history_falloff_per_alpha) * s.roughness,
                                 s.roughness, set(shared::surface_history_falloff_smooth));
    const V trust = hn::Exp(d_, hn::Max(hn::Neg(separation / falloff), set(-80.0f)));
    if (hn::AllFalse(d_, elsewhere)) {
      HistorySample history = fetch_history(own);
      history.frames = history.frames * trust;
      return history;
    }
    const VI id = hn::BitCast(di_, plane(ring, y, instance, x));
    const HistoryTaps<D> reflected = virtual_taps(here_x + motion.x, here_y + motion.y, elsewhere,
                                                  id, s, curvature.normal_change);
    const M by_reflection = hn::And(reflected.any(), elsewhere);
    HistorySample history = fetch_history(chosen(by_reflection, reflected, own));
    const V narrow_lobe = hn::Max(lobe - set(shared::virtual_history_min_lobe), hn::Zero(d_));
    const V kept = hn::Min(history.frames, set(shared::virtual_history_per_pixel) * narrow_lobe);
    history.frames = hn::IfThenElse(by_reflection, kept, history.frames * trust);
    return history;
  }

  HWY_INLINE HistoryTaps<D> chosen(M first, const HistoryTaps<D>& a,
                                   const HistoryTaps<D>& b) const {
    HistoryTaps<D> taps = b;
    const auto whole = hn::RebindMask(di_, first);
    taps.x = hn::IfThenElse(whole, a.x, b.x);
    taps.y = hn::IfThenElse(whole, a.y, b.y);
    for (int i = 0; i < 4; ++i) {
      taps.weights[i] = hn::IfThenElse(first, a.weights[i], b.weights[i]);
    }
    taps.fraction_x = hn::IfThenElse(first, a.fraction_x, b.fraction_x);
    taps.fraction_y = hn::IfThenElse(first, a.fraction_y, b.fraction_y);
    taps.whole = hn::Or(hn::And(first, a.whole), hn::AndNot(first, b.whole));
    return taps;
  }

  /// In frames; frames_under_motion() of shaders/lib/denoise/moments.glsl for the environment.
  HWY_INLINE V max_history_frames(V roughness) const {
    const V longest =
        set(std::min(c_.frames, shared::specular_light_history_scale * c_.light_frames));
    if (c_.environment_turn <= 0.0f) return longest;
    const V lobe = set(4.0f) * hn::Atan(d_, roughness * roughness);
    const V motion = set(c_.environment_turn) / hn::Max(lobe, set(1e-4f));
    const V logarithm = hn::Log(d_, clamped(motion, 1e-6f, 1.0f));
    const V power = hn::Exp(d_, set(shared::motion_history_exponent) * logarithm);
    return hn::Min(longest,
                   hn::MulAdd(set(shared::motion_history_factor), power - set(1.0f), set(1.0f)));
  }

  HWY_INLINE void block(const RowRing& ring, const ViewedRow<D>& view, int x, int y) const {
    const V zero = hn::Zero(d_), one = set(1.0f);
    const Surface s{three_planes(ring, y, normal, x), plane(ring, y, roughness, x),
                    plane(ring, y, view_z, x)};
    const M seen = hn::Gt(s.view_z, zero);
    const Quad<V> nothing_seen{zero, zero, zero, zero};
    float* const signal = row_of<float>(job_.signal, y) + 4 * x;
    const Rounding<D> rounding(x, y, job_.frame.sample_index);
    const auto keep = [&](const gpu::HostView& image, const Quad<V>& t)
                          HWY_ATTR { store_history4<Halves>(d_, t, rounding, image, x, y); };
    if (hn::AllFalse(d_, seen)) {
      store4(d_, nothing_seen, signal);
      keep(job_.history, nothing_seen);
      keep(job_.history_length, nothing_seen);
      keep(job_.fast_history, nothing_seen);
      return;
    }
    const Triple<V> now = three_planes(ring, y, radiance, x);
    const HistorySample old = reprojected_history(ring, view, x, y, seen, s);

    // The history counts what was sampled: without a sample it stays as it is.
    const V noisy_distance = load(job_.noisy, x, y).w;
    const V distance = hn::IfThenZeroElse(is_bad(noisy_distance), noisy_distance);
    const M left_out = hn::Lt(distance, zero);
    const V sampled = hn::IfThenZeroElse(left_out, one);
    const V frames = hn::Min(old.frames + sampled, max_history_frames(s.roughness));
    const V counted = hn::Max(frames, one);
    const Triple<V> mean = mix(old.radiance, now, sampled / counted);
    const V known = hn::Min(counted, set(c_.moments_frames));
    const V bright = luminance(now);
    const V first = mix(old.moments.x, bright, sampled / known);
    const V second = mix(old.moments.y, bright * bright, sampled / known);
    V variance = sample_variance(first, second, known);
    if (c_.flags & shared::temporal_mean_variance) variance = variance / counted;
    Triple<V> recent = mix(old.fast, now, sampled / hn::Min(counted, set(fast_frames)));
    if (c_.rectification == shared::rectification_gradient) {
      const M changed = hn::AndNot(left_out, hn::Gt(old.frames, zero));
      recent = select(changed, now - old.radiance, Triple<V>{zero, zero, zero});
    }

    const V deviation = hn::Sqrt(hn::Max(hn::NegMulAdd(first, first, second), zero));
    store4(d_, select(seen, Quad<V>{mean.x, mean.y, mean.z, variance}, nothing_seen), signal);
    keep(job_.history, select(seen, Quad<V>{mean.x, mean.y, mean.z, distance}, nothing_seen));
    keep(job_.history_length, select(seen, Quad<V>{frames, zero, first, deviation}, nothing_seen));
    keep(job_.fast_history,
         select(seen, Quad<V>{recent.x, recent.y, recent.z, distance}, nothing_seen));
  }

  const D d_{};
  const DI di_{};
  const TemporalSpecularJob& job_;
  const shared::TemporalConstants& c_;
  Bounds<D> bounds_;
};

void accumulate_specular_rows(const TemporalSpecularJob& job, int first, int last) {
  run_rows<SpecularAccumulation>(job, job.width, first, last);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(accumulate_specular_rows);

void specular_temporal(const TemporalSpecularJob& job) {
  for_each_band(job.height, [&](int first, int last) {
    HWY_DYNAMIC_DISPATCH(accumulate_specular_rows)(job, first, last);
  });
}

}  // namespace heliograph::render::kernels
#endif
