#include "tracing/driver/device_structures.hpp"

#include <algorithm>
#include <string>

#include "tracing/bvh/bvh.hpp"

namespace heliograph::tracing {
namespace {

constexpr VkDeviceSize hierarchy_alignment = 256;  // of offsets into a buffer of hierarchies
constexpr VkDeviceSize scratch_budget = VkDeviceSize(64) << 20;
constexpr VkBufferUsageFlags hierarchy_usage =
    VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR |
    VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
constexpr VkBufferUsageFlags scratch_usage =
    VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;

VkDeviceSize aligned(VkDeviceSize size, VkDeviceSize alignment) {
  return (size + alignment - 1) / alignment * alignment;
}

VkPhysicalDeviceAccelerationStructurePropertiesKHR structure_limits(const gpu::Device& device) {
  VkPhysicalDeviceAccelerationStructurePropertiesKHR limits{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_PROPERTIES_KHR};
  VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &limits};
  vkGetPhysicalDeviceProperties2(device.physical(), &properties);
  return limits;
}

void check_count(const char* what, std::uint64_t count, std::uint64_t most) {
  if (count <= most) return;
  throw gpu::GpuError(std::string(what) + " " + std::to_string(count) +
                      ", but the device traces at most " + std::to_string(most));
}

VkAccelerationStructureBuildGeometryInfoKHR build_info(
    VkAccelerationStructureTypeKHR type, VkBuildAccelerationStructureFlagsKHR flags,
    const VkAccelerationStructureGeometryKHR& geometry) {
  VkAccelerationStructureBuildGeometryInfoKHR info{
      VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR};
  info.type = type;
  info.flags = flags;
  info.geometryCount = 1;
  info.pGeometries = &geometry;
  return info;
}

VkAccelerationStructureBuildSizesInfoKHR build_sizes(
    const gpu::Device& device, const VkAccelerationStructureBuildGeometryInfoKHR& info,
    std::uint32_t count) {
  VkAccelerationStructureBuildSizesInfoKHR sizes{
      VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR};
  vkGetAccelerationStructureBuildSizesKHR(
      device.handle(), VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR, &info, &count, &sizes);
  return sizes;
}

VkAccelerationStructureGeometryKHR triangle_geometry(const DeviceTriangles& mesh) {
  VkAccelerationStructureGeometryKHR geometry{
      VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR};
  geometry.geometryType = VK_GEOMETRY_TYPE_TRIANGLES_KHR;
  geometry.flags = mesh.masked ? 0 : VK_GEOMETRY_OPAQUE_BIT_KHR;
  auto& triangles = geometry.geometry.triangles;
  triangles = {VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_TRIANGLES_DATA_KHR};
  triangles.vertexFormat = VK_FORMAT_R32G32B32_SFLOAT;
  triangles.vertexData.deviceAddress = mesh.positions;
  triangles.vertexStride = sizeof(glm::vec3);
  triangles.maxVertex = mesh.position_count - 1;
  triangles.indexType = VK_INDEX_TYPE_UINT32;
  triangles.indexData.deviceAddress = mesh.indices;
  return geometry;
}

/// Scratch memory with `size` usable bytes from an aligned address.
gpu::Buffer make_scratch(const gpu::Device& device, VkDeviceSize size, VkDeviceSize alignment) {
  return {device, "build scratch", size + alignment, scratch_usage, gpu::Memory::device};
}

}  // namespace

MeshHierarchies::MeshHierarchies(const gpu::Device& device, std::span<const DeviceTriangles> meshes,
                                 Rebuilds rebuilds)
    : flags_(rebuilds == Rebuilds::never
                 ? VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR
                 : VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_BUILD_BIT_KHR) {
  const auto limits = structure_limits(device);
  scratch_alignment_ = limits.minAccelerationStructureScratchOffsetAlignment;
  VkDeviceSize size = 0, scratch = 0, largest = 0;
  for (const DeviceTriangles& mesh : meshes) {
    check_count("triangles of a mesh:", mesh.triangle_count, limits.maxPrimitiveCount);
    builds_.push_back(mesh.triangle_count > 0 ? plan(device, mesh) : Build{});
    builds_.back().offset = size;
    const auto& sizes = builds_.back().sizes;
    size += aligned(sizes.accelerationStructureSize, hierarchy_alignment);
    scratch += aligned(sizes.buildScratchSize, scratch_alignment_);
    largest = std::max(largest, aligned(sizes.buildScratchSize, scratch_alignment_));
  }
  hierarchies_.resize(meshes.size());
  if (size == 0) return;
  memory_ = gpu::Buffer(device, "mesh hierarchies", size, hierarchy_usage, gpu::Memory::device);
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < builds_.size(); ++i) {
    if (builds_[i].triangle_count == 0) continue;
    hierarchies_[i] =
        gpu::RayHierarchy(device, VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR, memory_,
                          builds_[i].offset, builds_[i].sizes.accelerationStructureSize);
    all.push_back(i);
  }
  scratch_ = make_scratch(device, std::max(largest, std::min(scratch, scratch_budget)),
                          scratch_alignment_);
  device.submit_once([&](VkCommandBuffer commands) { record_rebuild(commands, all); });
  if (rebuilds == Rebuilds::never) scratch_ = {};
}

MeshHierarchies::Build MeshHierarchies::plan(const gpu::Device& device,
                                             const DeviceTriangles& mesh) const {
  Build build{triangle_geometry(mesh), {}, mesh.triangle_count, 0};
  build.sizes = build_sizes(
      device, build_info(VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR, flags_, build.geometry),
      mesh.triangle_count);
  return build;
}

void MeshHierarchies::record_rebuild(VkCommandBuffer commands,
                                     std::span<const std::size_t> meshes) const {
  const VkDeviceAddress start = aligned(scratch_.address(), scratch_alignment_);
  const VkDeviceAddress end = scratch_.address() + scratch_.size();
  VkDeviceAddress room = start;
  for (const std::size_t i : meshes) {
    const Build& build = builds_[i];
    if (build.triangle_count == 0) continue;
    const VkDeviceSize needed = aligned(build.sizes.buildScratchSize, scratch_alignment_);
    if (room + needed > end) {
      gpu::full_barrier(commands);  // previous builds must have finished with the scratch memory
      room = start;
    }
    auto info = build_info(VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR, flags_, build.geometry);
    info.dstAccelerationStructure = hierarchies_[i].handle();
    info.scratchData.deviceAddress = room;
    room += needed;
    const VkAccelerationStructureBuildRangeInfoKHR range{build.triangle_count, 0, 0, 0};
    const auto* ranges = &range;
    vkCmdBuildAccelerationStructuresKHR(commands, 1, &info, &ranges);
  }
  gpu::full_barrier(commands);
}

InstanceHierarchy::InstanceHierarchy(const gpu::Device& device, std::uint32_t count)
    : count_(count),
      instances_(device, "instances of the hierarchy",
                 count * sizeof(VkAccelerationStructureInstanceKHR),
                 VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR |
                     VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT,
                 gpu::Memory::upload) {
  const auto limits = structure_limits(device);
  check_count("instances of the scene:", count, limits.maxInstanceCount);
  geometry_ = {VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR};
  geometry_.geometryType = VK_GEOMETRY_TYPE_INSTANCES_KHR;
  geometry_.geometry.instances = {
      VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR};
  geometry_.geometry.instances.data.deviceAddress = instances_.address();
  const auto sizes =
      build_sizes(device,
                  build_info(VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR,
                             VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR, geometry_),
                  count);
  memory_ = gpu::Buffer(device, "instance hierarchy", sizes.accelerationStructureSize,
                        hierarchy_usage, gpu::Memory::device);
  hierarchy_ = gpu::RayHierarchy(device, VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR, memory_, 0,
                                 sizes.accelerationStructureSize);
  const VkDeviceSize alignment = limits.minAccelerationStructureScratchOffsetAlignment;
  scratch_ = make_scratch(device, sizes.buildScratchSize, alignment);
  scratch_address_ = aligned(scratch_.address(), alignment);
}

void InstanceHierarchy::place(std::uint32_t index, VkDeviceAddress mesh, const glm::mat4& world) {
  VkAccelerationStructureInstanceKHR instance{};
  const glm::mat4 rows = glm::transpose(world);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      instance.transform.matrix[row][column] = rows[row][column];
    }
  }
  instance.mask = 0xff;
  instance.accelerationStructureReference = traceable_inverse(world) ? mesh : 0;
  reinterpret_cast<VkAccelerationStructureInstanceKHR*>(instances_.mapped())[index] = instance;
}

void InstanceHierarchy::record_build(VkCommandBuffer commands) const {
  auto info = build_info(VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR,
                         VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR, geometry_);
  info.dstAccelerationStructure = hierarchy_.handle();
  info.scratchData.deviceAddress = scratch_address_;
  const VkAccelerationStructureBuildRangeInfoKHR range{count_, 0, 0, 0};
  const auto* ranges = &range;
  vkCmdBuildAccelerationStructuresKHR(commands, 1, &info, &ranges);
  gpu::full_barrier(commands);
}

glm::uvec2 InstanceHierarchy::address() const {
  return {static_cast<std::uint32_t>(hierarchy_.address()),
          static_cast<std::uint32_t>(hierarchy_.address() >> 32)};
}

}  // namespace heliograph::tracing
