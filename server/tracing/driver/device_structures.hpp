#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "gpu/pipelines/ray_hierarchy.hpp"

namespace heliograph::tracing {

/// Triangles in device buffers, as input of the driver's builder.
struct DeviceTriangles {
  VkDeviceAddress positions = 0;  // three floats each; NaN in x: inactive
  std::uint32_t position_count = 0;
  VkDeviceAddress indices = 0;  // three uint per triangle
  std::uint32_t triangle_count = 0;
  bool masked = false;  // alpha tested in the shader
};

enum class Rebuilds { never, often };

/// Bottom-level acceleration structures, one per mesh.
class MeshHierarchies {
 public:
  MeshHierarchies() = default;
  /// Builds all structures. Meshes without triangles get none.
  /// @throws gpu::GpuError when a mesh has more triangles than the device allows
  MeshHierarchies(const gpu::Device& device, std::span<const DeviceTriangles> meshes,
                  Rebuilds rebuilds);

  /// Device address of a mesh's structure; 0 where it has no triangles.
  VkDeviceAddress address(std::size_t mesh) const { return hierarchies_[mesh].address(); }
  std::uint64_t bytes() const { return memory_.size() + scratch_.size(); }

  /// Rebuilds the structures of deforming meshes from positions updated in place. Rebuilt instead
  /// of refitted: equally fast to trace in any pose, and triangles may become inactive and active
  /// again.
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

/// The top-level acceleration structure over instances.
class InstanceHierarchy {
 public:
  /// Does not build yet. @throws gpu::GpuError when the device does not allow `count` instances
  InstanceHierarchy(const gpu::Device& device, std::uint32_t count);

  /// Sets instance `index` for the next build. `mesh`: 0 or an address from MeshHierarchies; rays
  /// miss instances with mesh 0 or a singular matrix.
  void place(std::uint32_t index, VkDeviceAddress mesh, const glm::mat4& world);

  /// Builds over the instances, which must not change until the build is done.
  void record_build(VkCommandBuffer commands) const;

  /// Device address for shaders, low half first.
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
