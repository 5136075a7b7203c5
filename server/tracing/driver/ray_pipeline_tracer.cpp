#include <memory>
#include <string>

#include "shaders/embedded.hpp"
#include "tracing/driver/driver_tracer.hpp"

namespace heliograph::tracing {
namespace {

const gpu::Device& with_ray_pipeline(const gpu::Device& device) {
  if (device.report().rays.pipeline) return device;
  throw gpu::GpuError("the tracer \"ray_pipeline\" needs VK_KHR_ray_tracing_pipeline, which " +
                      device.report().name + " (" + device.report().driver +
                      ") lacks; use \"software\"");
}

gpu::RayStages stages(const gpu::ShaderBinary& generation) {
  return {generation, shaders::trace_rmiss, shaders::trace_rchit, shaders::trace_rahit};
}

class RayPipelineTracer : public DriverTracer<gpu::RayProgram> {
 public:
  explicit RayPipelineTracer(const gpu::Device& device)
      : DriverTracer(with_ray_pipeline(device), stages(shaders::trace_closest_rgen),
                     stages(shaders::trace_any_rgen)) {}

  protocol::TracerKind kind() const override { return protocol::TracerKind::ray_pipeline; }

 private:
  // Launches the stream's capacity: threads beyond its count exit at once, which is cheaper than a
  // pass that writes indirect launch arguments.
  void start(gpu::PassBuilder& pass, const RayStream& rays) const override {
    pass.launch(rays.capacity);
  }
};

}  // namespace

std::unique_ptr<RayTracer> make_ray_pipeline_tracer(const gpu::Device& device) {
  return std::make_unique<RayPipelineTracer>(device);
}

}  // namespace heliograph::tracing
