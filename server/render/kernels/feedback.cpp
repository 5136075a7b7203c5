#include <type_traits>

#include "render/kernels/simd/rows.hpp"
#include "render/kernels/temporal.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/feedback.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/simd/denoise/history_texels.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// `Format`: of the history.
template <class D, class Job, class Format>
class Feedback {
 public:
  HWY_INLINE explicit Feedback(const Job& job) : job_(job) {}

  HWY_INLINE void rows(int first, int last) const {
    const int lanes = static_cast<int>(hn::Lanes(d_));
    for (int y = first; y < last; ++y) {
      for (int i = 0; i < job_.width; i += lanes) {
        const int x = std::min(i, job_.width - lanes);
        auto value = load4(d_, row_of<const float>(job_.filtered, y) + 4 * x);
        if constexpr (std::is_same_v<Job, SpecularFeedbackJob>) {
          // The distance to what is reflected
          value.w = load_history4<Format>(d_, job_.fast_history, x, y).w;
        }
        const Rounding<D> rounding(x, y, job_.frame.sample_index);
        store_history4<Format>(d_, value, rounding, job_.history, x, y);
      }
    }
  }

 private:
  const D d_{};
  const Job& job_;
};

template <class D>
using VisibilityFeedback = Feedback<D, VisibilityFeedbackJob, Fractions>;
template <class D>
using SpecularFeedback = Feedback<D, SpecularFeedbackJob, Halves>;

void feed_visibility_back(const VisibilityFeedbackJob& job, int first, int last) {
  run_rows<VisibilityFeedback>(job, job.width, first, last);
}

void feed_specular_back(const SpecularFeedbackJob& job, int first, int last) {
  run_rows<SpecularFeedback>(job, job.width, first, last);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(feed_visibility_back);
HWY_EXPORT(feed_specular_back);

void visibility_feedback(const VisibilityFeedbackJob& job) {
  for_each_band(job.height, [&](int first, int last) {
    HWY_DYNAMIC_DISPATCH(feed_visibility_back)(job, first, last);
  });
}

void specular_feedback(const SpecularFeedbackJob& job) {
  for_each_band(job.height, [&](int first, int last) {
    HWY_DYNAMIC_DISPATCH(feed_specular_back)(job, first, last);
  });
}

}  // namespace heliograph::render::kernels
#endif
