#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "render/frame/engine_parts.hpp"

namespace heliograph::test {

/// This run's engine with the tracer ("auto", "embree" ...) and the validation layers on, made
/// at the first call. HELIOGRAPH_TEST_DEVICE names a part of another device's name.
render::Engine& engine(const std::string& tracer = "auto");

/// The device of the engine that tests share.
inline const gpu::Device& device() {
  return engine().parts().device;
}

/// What answers rays on this run's device, the best first.
std::vector<std::string> offered_tracers();
bool is_offered(const std::string& tracer);
/// Why a test of a tracer that the device does not offer is skipped.
std::string lacking(const std::string& tracer);

/// What the validation layers have said to all engines so far.
std::uint64_t validation_messages();

/// Ends all engines.
void release_engines();

}  // namespace heliograph::test
