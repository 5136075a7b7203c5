#include "tracing/tracer_choice.hpp"

namespace heliograph::tracing {

using protocol::TracerKind;

std::vector<TracerKind> supported_tracers(const gpu::DeviceReport& device) {
  std::vector<TracerKind> offered;
  if (device.type == VK_PHYSICAL_DEVICE_TYPE_CPU) {
    offered = {TracerKind::embree, TracerKind::software};
    if (device.rays.query) offered.push_back(TracerKind::ray_query);
  } else {
    if (device.rays.query) offered.push_back(TracerKind::ray_query);
    offered.push_back(TracerKind::software);
  }
  if (device.rays.pipeline) offered.push_back(TracerKind::ray_pipeline);
  return offered;
}

std::unique_ptr<RayTracer> make_tracer(TracerKind kind, const gpu::Device& device) {
  switch (kind) {
    case TracerKind::embree:
      return make_embree_tracer(device);
    case TracerKind::ray_query:
      return make_ray_query_tracer(device);
    case TracerKind::ray_pipeline:
      return make_ray_pipeline_tracer(device);
    default:
      return make_software_tracer(device);
  }
}

std::unique_ptr<RayTracer> make_tracer(const std::string& requested, const gpu::Device& device) {
  if (requested == "auto") return make_tracer(supported_tracers(device.report()).front(), device);
  if (const auto kind = protocol::enum_value<TracerKind>(requested))
    return make_tracer(*kind, device);
  std::string names = "auto";
  for (const TracerKind kind : all_tracers) {
    names += ", " + std::string(protocol::enum_name(kind));
  }
  throw gpu::GpuError("there is no tracer \"" + requested + "\": choose one of " + names);
}

}  // namespace heliograph::tracing
