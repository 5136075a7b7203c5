#pragma once

#include <vector>

#include "gpu/frame_plan/pass_order.hpp"

namespace heliograph::gpu {

using Numbers = std::vector<std::uint32_t>;

inline Use reading(std::uint32_t resource) {
  return {resource, Access::read};
}
inline Use writing(std::uint32_t resource) {
  return {resource, Access::write};
}

/// The numbers of passes that a barrier stands in front of, as they run.
inline Numbers barriers(const PassOrder& order) {
  Numbers behind;
  for (const std::uint32_t pass : order.passes) {
    if (order.barrier_before[pass]) behind.push_back(pass);
  }
  return behind;
}

}  // namespace heliograph::gpu
