#include "render/kernels/reproject.hpp"

#include "render/kernels/simd/rows.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/reproject.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/simd/guide.hpp"
#include "render/kernels/simd/history.hpp"
#include "render/kernels/simd/view.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

template <class D>
class Reprojection {
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;
  using DI = hn::RebindToSigned<D>;
  using VI = hn::Vec<DI>;

  struct Expected {
    Triple<V> normal;
    V normal_allowance;
    V view_z;
    V depth_allowance;
    VI instance;
  };
  struct Match {
    V x, y;
    V taps;     // bits of those that are valid, as a number
    V nowhere;  // 1 where there is none
  };

 public:
  HWY_INLINE explicit Reprojection(const ReprojectJob& job)
      : job_(job), bounds_(job.width, job.height) {}

  HWY_INLINE void rows(int first, int last) const {
    const BandScratch normals(3, job_.width, first, last, 1);
    for (int y = first - 1; y <= last; ++y) decode_normals(normals, y);
    const int lanes = static_cast<int>(hn::Lanes(d_));
    for (int y = first; y < last; ++y) {
      const ViewedRow<D> view(job_.frame, y);
      for (int x = 0; x < job_.width; x += lanes) {
        block(normals, view, std::min(x, job_.width - lanes), y);
      }
    }
  }

 private:
  HWY_INLINE V set(float value) const { return hn::Set(d_, value); }

  /// Beyond the border the neighbour on the other side stands in.
  static int reflected_index(int i, int size) {
    const int inside = i < 0 ? 1 : i >= size ? size - 2 : i;
    return std::clamp(inside, 0, size - 1);
  }

  HWY_INLINE void decode_normals(const BandScratch& normals, int y) const {
    const float* const from = row_of<const float>(job_.normals, reflected_index(y, job_.height));
    const int lanes = static_cast<int>(hn::Lanes(d_));
    for (int i = 0; i < job_.width; i += lanes) {
      const int x = std::min(i, job_.width - lanes);
      const Quad<V> encoded = load4(d_, from + 4 * x);
      const Triple<V> normal = octahedral_decode(encoded.x, encoded.y);
      hn::StoreU(normal.x, d_, normals.row(0, y) + x);
      hn::StoreU(normal.y, d_, normals.row(1, y) + x);
      hn::StoreU(normal.z, d_, normals.row(2, y) + x);
    }
    for (int channel = 0; channel < 3; ++channel) {
      float* const row = normals.row(channel, y);
      row[-1] = row[reflected_index(-1, job_.width)];
      row[job_.width] = row[reflected_index(job_.width, job_.width)];
    }
  }

  HWY_INLINE Triple<V> normal_at(const BandScratch& normals, int x, int y) const {
    return {hn::LoadU(d_, normals.row(0, y) + x), hn::LoadU(d_, normals.row(1, y) + x),
            hn::LoadU(d_, normals.row(2, y) + x)};
  }

  /// How normals change toward the more similar neighbour of each axis.
  HWY_INLINE V normal_change(const BandScratch& normals, int x, int y,
                             const Triple<V>& normal) const {
    const auto to = [&](int dx, int dy) HWY_ATTR {
      return squared_distance(normal, normal_at(normals, x + dx, y + dy));
    };
    return hn::Sqrt(hn::Max(hn::Min(to(-1, 0), to(1, 0)), hn::Min(to(0, -1), to(0, 1))));
  }

  HWY_INLINE M is_same(VI x, VI y, M requested, const Expected& expected) const {
    const M candidates = hn::And(requested, bounds_.contain(x, y));
    if (hn::AllFalse(d_, candidates)) return candidates;
    const TexelGather<D> texels = bounds_.gather(x, y);
    const auto instance = hn::Eq(texels.word(job_.previous_instance), expected.instance);
    M same = hn::And(candidates, hn::RebindMask(d_, instance));
    const V previous_z = texels.last_of_four(job_.previous_motion);
    same = hn::And(same, hn::Gt(previous_z, hn::Zero(d_)));
    same = hn::And(same, hn::Le(hn::Abs(previous_z - expected.view_z), expected.depth_allowance));
    if (hn::AllFalse(d_, same)) return same;
    const Pair<V> encoded = texels.first_two(job_.previous_normals);
    const Triple<V> normal = octahedral_decode(encoded.x, encoded.y);
    const V allowed = expected.normal_allowance * expected.normal_allowance;
    same = hn::And(same, hn::Le(squared_distance(expected.normal, normal), allowed));
    return hn::And(same, hn::Gt(dot(expected.normal, normal), hn::Zero(d_)));
  }

  HWY_INLINE Match find(V x, V y, M requested, const Expected& expected) const {
    HistoryTaps<D> taps(x, y);
    const V zero = hn::Zero(d_);
    V bits = zero;
    for (int i = 0; i < 4; ++i) {
      const M weighs = hn::And(requested, hn::Gt(taps.weights[i], zero));
      const M same = is_same(taps.tap_x(i), taps.tap_y(i), weighs, expected);
      bits = bits + hn::IfThenElseZero(same, set(static_cast<float>(1 << i)));
      taps.weights[i] = hn::IfThenElseZero(same, taps.weights[i]);
    }
    const V sum = taps.weights[0] + taps.weights[1] + taps.weights[2] + taps.weights[3];
    const M known = hn::Ge(sum, set(0.01f));
    Match result{x, y, hn::IfThenElseZero(known, bits), hn::IfThenZeroElse(known, set(1.0f))};
    const M missing = hn::AndNot(known, requested);
    if (!hn::AllFalse(d_, missing)) find_nearest(x, y, missing, expected, result);
    return result;
  }

  /// The nearest of the 3x3 pixels about the position that shows the surface, as an exact position.
  HWY_INLINE void find_nearest(V x, V y, M missing, const Expected& expected, Match& result) const {
    V nearest = set(1e9f);
    for (int i = 0; i < 9; ++i) {
      const V column = clamped(hn::Floor(x) + set(static_cast<float>(i % 3 - 1)), -1e6f, 1e6f);
      const V row = clamped(hn::Floor(y) + set(static_cast<float>(i / 3 - 1)), -1e6f, 1e6f);
      const V middle_x = column + set(0.5f), middle_y = row + set(0.5f);
      const V away_x = middle_x - x, away_y = middle_y - y;
      const V far = hn::Sqrt(hn::MulAdd(away_x, away_x, away_y * away_y));
      const M nearer = hn::And(missing, hn::Lt(far, nearest));
      const M same = is_same(hn::ConvertTo(di_, column), hn::ConvertTo(di_, row), nearer, expected);
      nearest = hn::IfThenElse(same, far, nearest);
      result.x = hn::IfThenElse(same, middle_x, result.x);
      result.y = hn::IfThenElse(same, middle_y, result.y);
      result.taps = hn::IfThenElse(same, set(1.0f), result.taps);
      result.nowhere = hn::IfThenZeroElse(same, result.nowhere);
    }
  }

  HWY_INLINE void block(const BandScratch& normals, const ViewedRow<D>& view, int x, int y) const {
    const V zero = hn::Zero(d_), one = set(1.0f), half = set(0.5f);
    const Quad<V> moved = load4(d_, row_of<const float>(job_.motion, y) + 4 * x);
    const M seen = hn::Gt(moved.w, zero);
    const V here_x = hn::Iota(d_, static_cast<float>(x)) + half;
    const V here_y = set(static_cast<float>(y) + 0.5f);
    Match result{here_x, here_y, zero, hn::IfThenElseZero(seen, one)};
    Quad<V> guide{zero, zero, zero, zero};
    if (!hn::AllFalse(d_, seen)) {
      const Triple<V> normal = normal_at(normals, x, y);
      const V roughness =
          unorm8<0>(d_, hn::LoadU(du_, row_of<const std::uint32_t>(job_.surface, y) + x));
      const Quad<V> surface = encode_guide(Guide<V>{normal, roughness, moved.w});
      guide = {hn::IfThenElseZero(seen, surface.x), hn::IfThenElseZero(seen, surface.y),
               hn::IfThenElseZero(seen, surface.z), hn::IfThenElseZero(seen, surface.w)};
      if (job_.frame.history_invalid == 0) {
        const Expected expected = expect(normals, view, x, y, moved, normal);
        const V was_x = hn::MulAdd(moved.x, set(static_cast<float>(job_.width)), here_x);
        const V was_y = hn::MulAdd(moved.y, set(static_cast<float>(job_.height)), here_y);
        const Match moved_to = find(was_x, was_y, seen, expected);
        result = {hn::IfThenElse(seen, moved_to.x, here_x),
                  hn::IfThenElse(seen, moved_to.y, here_y), hn::IfThenElseZero(seen, moved_to.taps),
                  hn::IfThenElseZero(seen, moved_to.nowhere)};
      }
    }
    store4(d_, guide, row_of<float>(job_.guide, y) + 4 * x);
    store4(d_, {result.x, result.y, result.taps, result.nowhere},
           row_of<float>(job_.reprojection, y) + 4 * x);
  }

  HWY_INLINE Expected expect(const BandScratch& normals, const ViewedRow<D>& view, int x, int y,
                             const Quad<V>& moved, const Triple<V>& normal) const {
    Expected expected;
    expected.normal = normal;
    expected.normal_allowance =
        set(job_.constants.normal_tolerance) * (normal_change(normals, x, y, normal) + set(0.01f));
    expected.view_z = moved.w + moved.z;
    const Pair<V> slope = load2(d_, row_of<const float>(job_.depth_slope, y) + 2 * x);
    const V footprint = view.footprint(expected.view_z);
    const V change = hn::Abs(slope.x) + hn::Abs(slope.y) + set(0.5f) * footprint;
    expected.depth_allowance = set(job_.constants.depth_tolerance) * change;
    expected.instance = hn::LoadU(di_, row_of<const int>(job_.instance, y) + x);
    return expected;
  }

  const D d_{};
  const DI di_{};
  const hn::RebindToUnsigned<D> du_{};
  const ReprojectJob& job_;
  Bounds<D> bounds_;
};

void reproject_rows(const ReprojectJob& job, int first, int last) {
  run_rows<Reprojection>(job, job.width, first, last);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(reproject_rows);

void reproject(const ReprojectJob& job) {
  for_each_band(job.height, [&](int first, int last) {
    HWY_DYNAMIC_DISPATCH(reproject_rows)(job, first, last);
  });
}

}  // namespace heliograph::render::kernels
#endif
