#pragma once

#include "gpu/device/device.hpp"

namespace heliograph::bench {

/// Bytes read and written per second, best of several runs.
struct CopyRates {
  double shader;     // a compute shader that copies an rgba32f image of this size
  double processor;  // memcpy on every core, of as many bytes
};

CopyRates measure_copy_rates(const gpu::Device& device, VkExtent2D extent);

}  // namespace heliograph::bench
