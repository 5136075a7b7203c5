#include "render/kernels/atrous.hpp"

#include <cmath>

#include "render/kernels/common/area.hpp"
#include "render/kernels/simd/rows.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/atrous.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/simd/denoise/atrous_filter.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

template <class Job>
HWY_INLINE AtrousPass make_pass(const Job& job, const shared::AtrousConstants& constants) {
  const shared::FrameConstants& frame = job.frame;
  return {constants,
          frame,
          job.depth_slope,
          job.height,
          2.0f * std::abs(frame.unproject.y) / static_cast<float>(frame.extent.y) *
              static_cast<float>(constants.pixels_per_texel),
          (frame.flags & shared::frame_orthographic) != 0,
          atrous_steps(constants)};
}

/// One iteration in one pass.
template <class D, bool visibility>
class AtrousWhole {
  using Rows = SignalRows<D, visibility>;

 public:
  HWY_INLINE AtrousWhole(const AtrousJob& job, const Area& area)
      : job_(job),
        area_(area),
        pass_(make_pass(job, job.constants)),
        reach_(pass_.steps.reach()),
        rows_(job.guide, job.signal, job.width, job.height,
              {area.left, area.right, std::max(area.top - reach_, 0), area.bottom},
              {reach_, reach_, reach_}),
        filter_(pass_, rows_) {}

  HWY_INLINE void run() {
    const int lanes = static_cast<int>(hn::Lanes(d_));
    for (int y = area_.top; y < area_.bottom; ++y) {
      rows_.advance(y);
      filter_.begin_row(area_.left, area_.right, y);
      float* const out = row_of<float>(job_.filtered, y);
      for (int start = area_.left; start < area_.right; start += lanes) {
        const int x = std::min(start, area_.right - lanes);
        store4(d_, filter_.filtered(x, y), out + 4 * x);
      }
    }
  }

 private:
  const D d_{};
  const AtrousJob& job_;
  Area area_;
  AtrousPass pass_;
  int reach_;
  Rows rows_;
  AtrousFilter<D, visibility, false, Rows::signal> filter_;
};

/// Both halves of an iteration: rows of the first stay in the cache for the second.
template <class D, bool visibility>
class AtrousHalfPair {
  using Rows = SignalRows<D, visibility>;

 public:
  HWY_INLINE AtrousHalfPair(const AtrousHalvesJob& job, const Area& area)
      : job_(job),
        area_(area),
        first_pass_(make_pass(job, job.constants.first)),
        second_pass_(make_pass(job, job.constants.second)),
        across_first_(job.constants.first.columns > 0),
        reach_(first_pass_.steps.reach()),
        between_(grown(area, across_first_ ? 1 : reach_, across_first_ ? reach_ : 1)),
        rows_(job.guide, job.signal, job.width, job.height,
              grown(between_, across_first_ ? reach_ : 1, across_first_ ? 1 : reach_),
              {reach_, across_first_ ? 2 * reach_ : reach_, across_first_ ? 1 : reach_}, 2),
        first_(first_pass_, rows_),
        second_(second_pass_, rows_) {}

  HWY_INLINE void run() {
    const int ahead = across_first_ ? reach_ : 1;
    for (int y = area_.top, next = between_.top; y < area_.bottom; ++y) {
      for (; next <= std::min(y + ahead, job_.height - 1); ++next) filter_first(next);
      filter_second(y);
    }
  }

 private:
  Area grown(const Area& area, int columns, int rows) const {
    return {std::max(area.left - columns, 0), std::min(area.right + columns, job_.width),
            std::max(area.top - rows, 0), std::min(area.bottom + rows, job_.height)};
  }

  HWY_INLINE void filter_first(int y) {
    const int lanes = static_cast<int>(hn::Lanes(d_));
    rows_.advance(y);
    first_.begin_row(between_.left, between_.right, y);
    for (int start = between_.left; start < between_.right; start += lanes) {
      const int x = std::min(start, between_.right - lanes);
      rows_.store_second(first_.filtered(x, y), x, y);
    }
    rows_.extend_second(y);
  }

  HWY_INLINE void filter_second(int y) {
    const int lanes = static_cast<int>(hn::Lanes(d_));
    second_.begin_row(area_.left, area_.right, y);
    float* const out = row_of<float>(job_.filtered, y);
    for (int start = area_.left; start < area_.right; start += lanes) {
      const int x = std::min(start, area_.right - lanes);
      store4(d_, second_.filtered(x, y), out + 4 * x);
    }
  }

  const D d_{};
  const AtrousHalvesJob& job_;
  Area area_;
  AtrousPass first_pass_, second_pass_;
  bool across_first_;
  int reach_;
  Area between_;  // where the first half is needed
  Rows rows_;
  AtrousFilter<D, visibility, true, Rows::signal> first_;
  AtrousFilter<D, visibility, true, Rows::second_signal> second_;
};

template <template <class, bool> class Kernel, bool visibility, class Job>
void filter_in_lanes(const Job& job, const Area& area) {
  using Wide = hn::ScalableTag<float>;
  using Single = hn::FixedTag<float, 1>;
  if (job.width >= static_cast<int>(hn::Lanes(Wide()))) {
    Kernel<Wide, visibility>(job, area).run();
  } else {
    Kernel<Single, visibility>(job, area).run();
  }
}

void filter_visibility(const AtrousJob& job, const Area& area) {
  filter_in_lanes<AtrousWhole, true>(job, area);
}
void filter_specular(const AtrousJob& job, const Area& area) {
  filter_in_lanes<AtrousWhole, false>(job, area);
}
void filter_visibility_halves(const AtrousHalvesJob& job, const Area& area) {
  filter_in_lanes<AtrousHalfPair, true>(job, area);
}
void filter_specular_halves(const AtrousHalvesJob& job, const Area& area) {
  filter_in_lanes<AtrousHalfPair, false>(job, area);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(filter_visibility);
HWY_EXPORT(filter_specular);
HWY_EXPORT(filter_visibility_halves);
HWY_EXPORT(filter_specular_halves);

namespace {

constexpr int parts(int size, int part) {
  return std::max((size + part / 2) / part, 1);
}

/// What is filtered first must exist beside an area, too, in the direction of the second half: few
/// areas in that direction waste least. At least one for each processor.
Areas divided(const AtrousHalvesJob& job) {
  const bool across_first = job.constants.first.columns > 0;
  Areas areas = across_first ? Areas{parts(job.width, 128), parts(job.height, 180)}
                             : Areas{1, parts(job.height, 45)};
  int& number = across_first ? areas.rows : areas.columns;
  constexpr int least_side = 32;
  const int most = (across_first ? job.height : job.width) / least_side;
  while (areas.count() < processors() && 2 * number <= most) number *= 2;
  return areas;
}
Areas divided(const AtrousJob& job) {
  constexpr int band = 64;
  return {1, parts(job.height, band)};
}

int pixels_per_texel(const AtrousJob& job) {
  return job.constants.pixels_per_texel;
}
int pixels_per_texel(const AtrousHalvesJob& job) {
  return job.constants.first.pixels_per_texel;
}

/// Calls `filter(job, area)` with a job of the images' size.
template <class Job, class Filter>
void for_each_area(Job job, const Filter& filter) {
  const int side = pixels_per_texel(job);
  job.width = (job.width + side - 1) / side;
  job.height = (job.height + side - 1) / side;
  const Areas areas = divided(job);
  for_each_range(areas.count(), 1,
                 [&](int first, int) { filter(job, areas.at(first, job.width, job.height)); });
}

}  // namespace

void visibility_atrous(const AtrousJob& whole) {
  for_each_area(whole, [](const AtrousJob& job, const Area& area) {
    HWY_DYNAMIC_DISPATCH(filter_visibility)(job, area);
  });
}

void specular_atrous(const AtrousJob& whole) {
  for_each_area(whole, [](const AtrousJob& job, const Area& area) {
    HWY_DYNAMIC_DISPATCH(filter_specular)(job, area);
  });
}

void visibility_atrous_halves(const AtrousHalvesJob& whole) {
  for_each_area(whole, [](const AtrousHalvesJob& job, const Area& area) {
    HWY_DYNAMIC_DISPATCH(filter_visibility_halves)(job, area);
  });
}

void specular_atrous_halves(const AtrousHalvesJob& whole) {
  for_each_area(whole, [](const AtrousHalvesJob& job, const Area& area) {
    HWY_DYNAMIC_DISPATCH(filter_specular_halves)(job, area);
  });
}

}  // namespace heliograph::render::kernels
#endif
