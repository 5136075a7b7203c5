#include <memory>
#include <string>
#include <utility>

#include "shaders/embedded.hpp"
#include "tracing/device_scene.hpp"
#include "tracing/ray_tracer.hpp"

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

class RayPipelineTracer : public RayTracer {
 public:
  explicit RayPipelineTracer(const gpu::Device& device)
      : device_(with_ray_pipeline(device)),
        closest_(device, stages(shaders::trace_closest_rgen)),
        any_(device, stages(shaders::trace_any_rgen)) {}

  protocol::TracerKind kind() const override { return protocol::TracerKind::ray_pipeline; }

  std::shared_ptr<const AccelerationStructure> build(const scene::Scene& scene,
                                                     const SceneBuffers& buffers) const override {
    return std::make_shared<RestingDeviceScene>(device_, scene, buffers.alpha_heap);
  }

  std::unique_ptr<MovingStructure> build_moving(std::shared_ptr<const AccelerationStructure> rest,
                                                const scene::Scene& scene,
                                                const SceneTables& tables) const override {
    return std::make_unique<MovingDeviceScene>(
        device_, std::dynamic_pointer_cast<const RestingDeviceScene>(std::move(rest)), scene,
        tables.alpha_heap);
  }

  void trace_closest(gpu::FramePlan& plan, const std::string& name,
                     const AccelerationStructure& structure, const RayStream& rays,
                     gpu::BufferRef hits) const override {
    add_pass(plan, name, closest_, structure, rays, hits);
  }

  void trace_any(gpu::FramePlan& plan, const std::string& name,
                 const AccelerationStructure& structure, const RayStream& rays,
                 gpu::BufferRef occluded) const override {
    add_pass(plan, name, any_, structure, rays, occluded);
  }

 private:
  // Launches as many as the stream has room for: those beyond its count end at once, which costs
  // less than a pass that turns the count into the arguments of an indirect launch.
  static void add_pass(gpu::FramePlan& plan, const std::string& name,
                       const gpu::RayProgram& program, const AccelerationStructure& structure,
                       const RayStream& rays, gpu::BufferRef answers) {
    const auto& scene = dynamic_cast<const DeviceScene&>(structure);
    gpu::PassBuilder pass = plan.pass(name, program);
    pass.read(rays.count).read(rays.rays);
    scene.bind(plan, pass);
    pass.write(answers).constants(scene.address()).launch(rays.capacity);
  }

  const gpu::Device& device_;
  gpu::RayProgram closest_;
  gpu::RayProgram any_;
};

}  // namespace

std::unique_ptr<RayTracer> make_ray_pipeline_tracer(const gpu::Device& device) {
  return std::make_unique<RayPipelineTracer>(device);
}

}  // namespace heliograph::tracing
