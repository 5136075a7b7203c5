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

/// The tracers that a device supports, the default first: "embree" on CPU devices, whose memory is
/// mapped; "ray_query" where supported; otherwise "software", which is faster than the driver's
/// pipeline on devices without ray tracing hardware. "ray_pipeline" is never the default.
std::vector<protocol::TracerKind> supported_tracers(const gpu::DeviceReport& device);

/// @throws gpu::GpuError when the device lacks what the tracer needs
std::unique_ptr<RayTracer> make_tracer(protocol::TracerKind kind, const gpu::Device& device);

/// `requested`: a tracer's name, or "auto" for the device's default.
/// @throws gpu::GpuError when there is no such tracer or the device does not support it
std::unique_ptr<RayTracer> make_tracer(const std::string& requested, const gpu::Device& device);

}  // namespace heliograph::tracing
