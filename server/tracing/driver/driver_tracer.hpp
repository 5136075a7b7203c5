#pragma once

#include <memory>
#include <string>
#include <utility>

#include "tracing/device_scene.hpp"
#include "tracing/ray_tracer.hpp"

namespace heliograph::tracing {

/// Shared by the tracers over the driver's acceleration structures: everything but the kind of
/// program and its dispatch.
template <class Program>
class DriverTracer : public RayTracer {
 public:
  std::shared_ptr<const AccelerationStructure> build(const scene::Scene& scene,
                                                     const SceneBuffers& buffers) const override {
    return std::make_shared<StaticDeviceScene>(device_, scene, buffers.alpha_heap);
  }

  std::shared_ptr<const AccelerationStructure> build_apart(
      const scene::Scene& scene, const SceneBuffers& buffers) const override {
    return build(scene, buffers);  // keeps every instance on its own
  }

  std::shared_ptr<const AccelerationStructure> build_without(
      const std::vector<bool>& hidden, std::shared_ptr<const AccelerationStructure> rest,
      const scene::Scene& scene, const SceneBuffers& buffers) const override {
    return std::make_shared<StaticDeviceScene>(
        device_, dynamic_cast<const StaticDeviceScene&>(*rest), scene, buffers.alpha_heap, hidden);
  }

  std::unique_ptr<MovingStructure> build_moving(std::shared_ptr<const AccelerationStructure> rest,
                                                const scene::Scene& scene,
                                                const SceneTables& tables) const override {
    return std::make_unique<MovingDeviceScene>(
        device_, std::dynamic_pointer_cast<const StaticDeviceScene>(std::move(rest)), scene,
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

 protected:
  template <class Source>
  DriverTracer(const gpu::Device& device, const Source& closest, const Source& any)
      : device_(device), closest_(device, closest), any_(device, any) {}

 private:
  virtual void start(gpu::PassBuilder& pass, const RayStream& rays) const = 0;

  void add_pass(gpu::FramePlan& plan, const std::string& name, const Program& program,
                const AccelerationStructure& structure, const RayStream& rays,
                gpu::BufferRef results) const {
    const auto& scene = dynamic_cast<const DeviceScene&>(structure);
    gpu::PassBuilder pass = plan.pass(name, program);
    pass.read(rays.count).read(rays.rays);
    scene.bind(plan, pass);
    pass.write(results).constants(scene.address());
    start(pass, rays);
  }

  const gpu::Device& device_;
  Program closest_;
  Program any_;
};

}  // namespace heliograph::tracing
