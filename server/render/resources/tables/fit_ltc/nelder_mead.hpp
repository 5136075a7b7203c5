#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace heliograph::ltc {

/// The downhill simplex of Nelder and Mead (1965): where `cost` of three numbers is least, starting
/// from a simplex of size `step` about `start`.
template <typename Cost>
std::array<double, 3> minimize(const std::array<double, 3>& start, double step, Cost cost) {
  using Point = std::array<double, 3>;
  struct Corner {
    Point at;
    double cost;
  };
  const auto corner = [&](const Point& at) { return Corner{at, cost(at)}; };
  std::array<Corner, 4> simplex;
  simplex[0] = corner(start);
  for (int i = 0; i < 3; ++i) {
    Point moved = start;
    moved[i] += step;
    simplex[i + 1] = corner(moved);
  }
  constexpr int most_rounds = 150;
  constexpr double tolerance = 1e-5;  // relative, of the cost
  for (int round = 0; round < most_rounds; ++round) {
    std::sort(simplex.begin(), simplex.end(),
              [](const Corner& a, const Corner& b) { return a.cost < b.cost; });
    if (simplex[3].cost - simplex[0].cost <= tolerance * std::abs(simplex[0].cost)) break;
    Point center{};
    for (int i = 0; i < 3; ++i) {
      for (int axis = 0; axis < 3; ++axis) center[axis] += simplex[i].at[axis] / 3.0;
    }
    const auto along = [&](double t) {
      Point at;
      for (int axis = 0; axis < 3; ++axis) {
        at[axis] = center[axis] + t * (simplex[3].at[axis] - center[axis]);
      }
      return corner(at);
    };
    const Corner reflected = along(-1.0);
    if (reflected.cost < simplex[0].cost) {
      const Corner expanded = along(-2.0);
      simplex[3] = expanded.cost < reflected.cost ? expanded : reflected;
      continue;
    }
    if (reflected.cost < simplex[2].cost) {
      simplex[3] = reflected;
      continue;
    }
    const Corner contracted = along(reflected.cost < simplex[3].cost ? -0.5 : 0.5);
    if (contracted.cost < std::min(reflected.cost, simplex[3].cost)) {
      simplex[3] = contracted;
      continue;
    }
    for (int i = 1; i < 4; ++i) {
      Point halved;
      for (int axis = 0; axis < 3; ++axis) {
        halved[axis] = 0.5 * (simplex[0].at[axis] + simplex[i].at[axis]);
      }
      simplex[i] = corner(halved);
    }
  }
  return std::min_element(simplex.begin(), simplex.end(),
                          [](const Corner& a, const Corner& b) { return a.cost < b.cost; })
      ->at;
}

}  // namespace heliograph::ltc
