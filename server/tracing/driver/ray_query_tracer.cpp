#include <cstddef>
#include <memory>
#include <string>

#include "shaders/embedded.hpp"
#include "shaders/shared/ray.h"
#include "tracing/driver/driver_tracer.hpp"

namespace heliograph::tracing {
namespace {

const gpu::Device& with_ray_query(const gpu::Device& device) {
  if (device.report().rays.query) return device;
  throw gpu::GpuError("the tracer \"ray_query\" needs VK_KHR_ray_query, which " +
                      device.report().name + " (" + device.report().driver +
                      ") lacks; use \"software\"");
}

class RayQueryTracer : public DriverTracer<gpu::ComputeProgram> {
 public:
  explicit RayQueryTracer(const gpu::Device& device)
      : DriverTracer(with_ray_query(device), shaders::trace_closest_query,
                     shaders::trace_any_query) {}

  protocol::TracerKind kind() const override { return protocol::TracerKind::ray_query; }

 private:
  void start(gpu::PassBuilder& pass, const RayStream& rays) const override {
    pass.dispatch_indirect(rays.count, offsetof(shared::RayCount, groups_x));
  }
};

}  // namespace

std::unique_ptr<RayTracer> make_ray_query_tracer(const gpu::Device& device) {
  return std::make_unique<RayQueryTracer>(device);
}

}  // namespace heliograph::tracing
