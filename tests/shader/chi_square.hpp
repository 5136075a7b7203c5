#pragma once

#include <cmath>
#include <vector>

namespace heliograph::test {

/// Whether counts that should all be alike are so by Pearson's test: the statistic, brought to a
/// standard normal number (Wilson and Hilferty 1931). Above 4: one chance in 30 000.
inline double chi_square_deviation(const std::vector<int>& counts) {
  double total = 0.0;
  for (const int count : counts) total += count;
  const double expected = total / static_cast<double>(counts.size());
  double statistic = 0.0;
  for (const int count : counts) statistic += (count - expected) * (count - expected) / expected;
  const double freedom = static_cast<double>(counts.size() - 1);
  const double variance = 2.0 / (9.0 * freedom);
  return (std::cbrt(statistic / freedom) - (1.0 - variance)) / std::sqrt(variance);
}

}  // namespace heliograph::test
