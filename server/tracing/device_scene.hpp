#pragma once

#include <memory>
#include <vector>

#include "tracing/bvh/mask_tables.hpp"
#include "tracing/driver/device_structures.hpp"
#include "tracing/ray_tracer.hpp"

namespace heliograph::tracing {

/// A scene in the driver's acceleration structures, for "ray_query" and "ray_pipeline".
class DeviceScene : public virtual AccelerationStructure {
 public:
  /// Push constants of the shaders; constant while the scene moves.
  glm::uvec2 address() const { return instances_.address(); }
  /// Binds the structure and alpha test tables to `pass`.
  void bind(gpu::FramePlan& plan, gpu::PassBuilder& pass) const;

 protected:
  DeviceScene(const gpu::Device& device, const scene::Scene& scene,
              std::shared_ptr<const MaskTables> masks, const gpu::Buffer& alpha_heap);

  std::shared_ptr<const MaskTables> masks_;
  const gpu::Buffer& alpha_heap_;
  InstanceHierarchy instances_;
};

class StaticDeviceScene : public DeviceScene {
 public:
  /// @throws gpu::GpuError when the scene is too large for the device
  StaticDeviceScene(const gpu::Device& device, const scene::Scene& scene,
                    const gpu::Buffer& alpha_heap);
  /// Without the instances for which `hidden` is true; shares the meshes of `rest`.
  StaticDeviceScene(const gpu::Device& device, const StaticDeviceScene& rest,
                    const scene::Scene& scene, const gpu::Buffer& alpha_heap,
                    const std::vector<bool>& hidden);

  const std::shared_ptr<const MaskTables>& masks() const { return masks_; }
  const MeshHierarchies& meshes() const { return *meshes_; }
  const std::vector<bool>& hidden() const { return hidden_; }
  std::uint64_t bytes() const override { return meshes_->bytes(); }

 private:
  void place_instances(const gpu::Device& device, const scene::Scene& scene);

  std::shared_ptr<const MeshHierarchies> meshes_;
  std::vector<bool> hidden_;  // by instance
};

/// An animated copy, which shares the rigid meshes with the static scene.
class MovingDeviceScene : public DeviceScene, public MovingStructure {
 public:
  MovingDeviceScene(const gpu::Device& device, std::shared_ptr<const StaticDeviceScene> rest,
                    const scene::Scene& scene, const gpu::Buffer& alpha_heap);

  void update(const Movement& movement) override;

 private:
  static constexpr std::size_t rigid = ~std::size_t(0);

  const gpu::Device& device_;
  std::shared_ptr<const StaticDeviceScene> rest_;
  std::vector<std::size_t> deforming_;       // per mesh: index among the deforming ones, or `rigid`
  std::vector<std::size_t> first_position_;  // per deforming mesh
  std::vector<VkDeviceAddress> mesh_addresses_;  // by instance
  gpu::Buffer positions_;
  gpu::Buffer indices_;
  MeshHierarchies meshes_;
};

}  // namespace heliograph::tracing
