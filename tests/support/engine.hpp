#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "render/frame/engine_parts.hpp"

namespace heliograph::test {

/// Shared engine with the tracer ("auto", "embree" ...) and validation layers, created on first
/// use. HELIOGRAPH_TEST_DEVICE selects a device by part of its name.
render::Engine& engine(const std::string& tracer = "auto");

/// The device of the engine that tests share.
inline const gpu::Device& device() {
  return engine().parts().device;
}

/// Tracers that the test device supports, fastest first.
std::vector<std::string> supported_tracers();
bool is_supported(const std::string& tracer);
/// Skip message for a tracer that the device does not support.
std::string unsupported_reason(const std::string& tracer);

/// Number of validation messages of all engines so far.
std::uint64_t validation_messages();

/// Destroys all engines.
void release_engines();

}  // namespace heliograph::test
