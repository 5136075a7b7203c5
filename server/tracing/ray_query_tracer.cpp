#include <cstddef>
#include <memory>
#include <string>
#include <utility>

#include "shaders/embedded.hpp"
#include "shaders/shared/ray.h"
#include "tracing/device_scene.hpp"
#include "tracing/ray_tracer.hpp"

namespace heliograph::tracing {
namespace {

const gpu::Device& with_ray_query(const gpu::Device& device) {
  if (device.report().rays.query) return device;
  throw gpu::GpuError("the tracer \"ray_query\" needs VK_KHR_ray_query, which " +
                      device.report().name + " (" + device.report().driver +
                      ") lacks; use \"software\"");
}

class RayQueryTracer : public RayTracer {
 public:
  explicit RayQueryTracer(const gpu::Device& device)
      : device_(with_ray_query(device)),
        closest_(device, shaders::trace_closest_query),
        any_(device, shaders::trace_any_query) {}

  protocol::TracerKind kind() const override { return protocol::TracerKind::ray_query; }

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
  static void add_pass(gpu::FramePlan& plan, const std::string& name,
                       const gpu::ComputeProgram& program, const AccelerationStructure& structure,
                       const RayStream& rays, gpu::BufferRef answers) {
    const auto& scene = dynamic_cast<const DeviceScene&>(structure);
    gpu::PassBuilder pass = plan.pass(name, program);
    pass.read(rays.count).read(rays.rays);
    scene.bind(plan, pass);
    pass.write(answers)
        .constants(scene.address())
        .dispatch_indirect(rays.count, offsetof(shared::RayCount, groups_x));
  }

  const gpu::Device& device_;
  gpu::ComputeProgram closest_;
  gpu::ComputeProgram any_;
};

}  // namespace

std::unique_ptr<RayTracer> make_ray_query_tracer(const gpu::Device& device) {
  return std::make_unique<RayQueryTracer>(device);
}

}  // namespace heliograph::tracing
