#pragma once

#include <memory>
#include <vector>

#include "tracing/bvh/mask_tables.hpp"
#include "tracing/driver/device_structures.hpp"
#include "tracing/ray_tracer.hpp"

namespace heliograph::tracing {

/// A scene in the driver's own hierarchies: what "ray_query" and "ray_pipeline" trace.
class DeviceScene : public virtual AccelerationStructure {
 public:
  /// What the shaders take as constants; stays when the scene moves.
  glm::uvec2 address() const { return instances_.address(); }
  /// Gives `pass` what lies between its rays and its answers.
  void bind(gpu::FramePlan& plan, gpu::PassBuilder& pass) const;

 protected:
  DeviceScene(const gpu::Device& device, const scene::Scene& scene,
              std::shared_ptr<const MaskTables> masks, const gpu::Buffer& alpha_heap);

  std::shared_ptr<const MaskTables> masks_;
  const gpu::Buffer& alpha_heap_;
  InstanceHierarchy instances_;
};

class RestingDeviceScene : public DeviceScene {
 public:
  /// @throws gpu::GpuError when the scene is too large for the device
  RestingDeviceScene(const gpu::Device& device, const scene::Scene& scene,
                     const gpu::Buffer& alpha_heap);

  const std::shared_ptr<const MaskTables>& masks() const { return masks_; }
  const MeshHierarchies& meshes() const { return meshes_; }
  std::uint64_t bytes() const override { return meshes_.bytes(); }

 private:
  MeshHierarchies meshes_;
};

/// Shares the meshes that keep their shape with the scene at rest.
class MovingDeviceScene : public DeviceScene, public MovingStructure {
 public:
  MovingDeviceScene(const gpu::Device& device, std::shared_ptr<const RestingDeviceScene> rest,
                    const scene::Scene& scene, const gpu::Buffer& alpha_heap);

  void update(const Movement& movement) override;

 private:
  static constexpr std::size_t rigid = ~std::size_t(0);

  const gpu::Device& device_;
  std::shared_ptr<const RestingDeviceScene> rest_;
  std::vector<std::size_t> deforming_;           // by mesh: its place among those, or `rigid`
  std::vector<std::size_t> first_position_;      // of each that deforms
  std::vector<VkDeviceAddress> mesh_addresses_;  // by instance
  gpu::Buffer positions_;
  gpu::Buffer indices_;
  MeshHierarchies meshes_;
};

}  // namespace heliograph::tracing
