#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "gpu/pipelines/ray_hierarchy.hpp"

namespace heliograph::tracing {

/// Triangles in device buffers, as the driver reads them when it builds.
struct DeviceTriangles {
  VkDeviceAddress positions = 0;  // three floats each; not a number in x: the corner is nowhere
  std::uint32_t position_count = 0;
  VkDeviceAddress indices = 0;  // three uint per triangle
  std::uint32_t triangle_count = 0;
  bool masked = false;  // some rays pass: the shader is asked
};

enum class Rebuilds { never, often };

/// The driver's hierarchies over meshes (bottom-level acceleration structures), one for each.
class MeshHierarchies {
 public:
  MeshHierarchies() = default;
  /// Builds all of them. Meshes without triangles get none.
  /// @throws gpu::GpuError when a mesh has more triangles than the device allows
  MeshHierarchies(const gpu::Device& device, std::span<const DeviceTriangles> meshes,
                  Rebuilds rebuilds);

  /// Where instances of the mesh lead; 0 where it has no triangles.
  VkDeviceAddress address(std::size_t mesh) const { return hierarchies_[mesh].address(); }
  std::uint64_t bytes() const { return memory_.size() + scratch_.size(); }

  /// Builds those of deforming meshes anew, over positions that changed where they lie. Built, not
  /// refitted: as fast to trace in any pose, and corners may turn into nothing and back.
  void record_rebuild(VkCommandBuffer commands, std::span<const std::size_t> meshes) const;

 private:
  struct Build {
    VkAccelerationStructureGeometryKHR geometry;
    VkAccelerationStructureBuildSizesInfoKHR sizes;
    std::uint32_t triangle_count;
    VkDeviceSize offset;
  };

  Build plan(const gpu::Device& device, const DeviceTriangles& mesh) const;

  VkBuildAccelerationStructureFlagsKHR flags_ = 0;
  VkDeviceSize scratch_alignment_ = 1;
  std::vector<Build> builds_;
  gpu::Buffer memory_;
  gpu::Buffer scratch_;  // for rebuilds
  std::vector<gpu::RayHierarchy> hierarchies_;
};

/// The driver's hierarchy over instances (a top-level acceleration structure).
class InstanceHierarchy {
 public:
  /// Nothing is built yet. @throws gpu::GpuError when the device does not allow `count` instances
  InstanceHierarchy(const gpu::Device& device, std::uint32_t count);

  /// Places instance `index`, for the next build. `mesh`: 0 or an address from MeshHierarchies;
  /// rays do not meet instances of 0, nor those whose matrix has no inverse.
  void place(std::uint32_t index, VkDeviceAddress mesh, const glm::mat4& world);

  /// Builds over what was placed; the instances must not change until that is done.
  void record_build(VkCommandBuffer commands) const;

  /// The address that shaders enter it by, low half first.
  glm::uvec2 address() const;

 private:
  VkAccelerationStructureGeometryKHR geometry_{};
  std::uint32_t count_;
  gpu::Buffer instances_;
  gpu::Buffer memory_;
  gpu::Buffer scratch_;
  VkDeviceAddress scratch_address_ = 0;
  gpu::RayHierarchy hierarchy_;
};

}  // namespace heliograph::tracing
