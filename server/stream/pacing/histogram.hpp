#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace heliograph::stream {

/// A histogram of durations with fixed bounds, for metrics.
class Histogram {
 public:
  /// Upper bounds, seconds.
  static constexpr std::array<double, 12> bounds{0.0001, 0.0003, 0.001, 0.0025, 0.005, 0.01,
                                                 0.025,  0.05,   0.1,   0.25,   1.0,   5.0};

  void add(double seconds) {
    const auto bound = std::lower_bound(bounds.begin(), bounds.end(), seconds);
    ++counts_[static_cast<std::size_t>(bound - bounds.begin())];
    sum_ += seconds;
  }
  void add(const Histogram& more) {
    for (std::size_t i = 0; i < counts_.size(); ++i) counts_[i] += more.counts_[i];
    sum_ += more.sum_;
  }

  /// Number of durations of at most bounds[i]; all for i = bounds.size().
  std::uint64_t up_to(std::size_t i) const {
    std::uint64_t count = 0;
    for (std::size_t k = 0; k <= i; ++k) count += counts_[k];
    return count;
  }
  std::uint64_t count() const { return up_to(bounds.size()); }
  double sum() const { return sum_; }

 private:
  std::array<std::uint64_t, bounds.size() + 1> counts_{};
  double sum_ = 0.0;
};

}  // namespace heliograph::stream
