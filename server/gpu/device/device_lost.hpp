#pragma once

#include <stdexcept>

namespace heliograph::gpu {

/// VK_ERROR_DEVICE_LOST: the device answers no more. All that was on it is gone, and it has to be
/// made again.
class DeviceLost : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace heliograph::gpu
