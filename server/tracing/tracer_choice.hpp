#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "tracing/ray_tracer.hpp"

namespace heliograph::tracing {

inline constexpr std::array all_tracers{
    protocol::TracerKind::embree, protocol::TracerKind::software, protocol::TracerKind::ray_query,
    protocol::TracerKind::ray_pipeline};

/// The tracers that a device can run, the one it gets unasked first: "embree" on CPU devices, whose
/// memory is ours; "ray_query" where the device has it; otherwise "software", which outruns the
/// driver's pipeline on devices without hardware for rays. "ray_pipeline" only ever comes by name.
std::vector<protocol::TracerKind> offered_tracers(const gpu::DeviceReport& device);

/// @throws gpu::GpuError when the device lacks what the tracer needs
std::unique_ptr<RayTracer> make_tracer(protocol::TracerKind kind, const gpu::Device& device);

/// `wanted`: a tracer's name, or "auto" for the first that the device offers.
/// @throws gpu::GpuError when there is no such tracer, or the device lacks what it needs
std::unique_ptr<RayTracer> make_tracer(const std::string& wanted, const gpu::Device& device);

}  // namespace heliograph::tracing
