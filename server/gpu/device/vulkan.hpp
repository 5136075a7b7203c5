#pragma once

#include <volk.h>

#include <stdexcept>
#include <string>

namespace heliograph::gpu {

class GpuError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// @throws GpuError naming `what` and the result when `result` is an error
void check(VkResult result, const char* what);

std::string to_string(VkResult result);

}  // namespace heliograph::gpu
