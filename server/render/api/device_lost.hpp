#pragma once

#include "gpu/device/device_lost.hpp"

namespace heliograph::render {

/// Whatever works on the device may throw it; Engine::recreate mends that.
using gpu::DeviceLost;

}  // namespace heliograph::render
