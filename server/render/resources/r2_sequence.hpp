#pragma once

#include <cmath>
#include <cstddef>
#include <glm/glm.hpp>

namespace heliograph::render {

/// Point number `i` of a sequence that fills the unit square evenly: R2, whose steps are the
/// inverse and the inverse square of the plastic number (Roberts 2018).
inline glm::dvec2 r2_point(std::size_t i) {
  const double x = 0.5 + static_cast<double>(i) * 0.7548776662466927;
  const double y = 0.5 + static_cast<double>(i) * 0.5698402909980532;
  return {x - std::floor(x), y - std::floor(y)};
}

}  // namespace heliograph::render
