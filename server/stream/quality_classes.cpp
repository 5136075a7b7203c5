#include "stream/quality_classes.hpp"

#include <algorithm>
#include <cstdlib>

namespace heliograph::stream {

std::vector<int> quality_classes(std::vector<int> wanted) {
  std::sort(wanted.begin(), wanted.end());
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  if (wanted.size() <= max_quality_classes) return wanted;
  return {wanted.front(), wanted[wanted.size() / 2], wanted.back()};
}

std::size_t nearest_class(const std::vector<int>& classes, int quality) {
  const auto nearest = std::min_element(classes.begin(), classes.end(), [&](int a, int b) {
    return std::abs(a - quality) < std::abs(b - quality);
  });
  return static_cast<std::size_t>(nearest - classes.begin());
}

}  // namespace heliograph::stream
