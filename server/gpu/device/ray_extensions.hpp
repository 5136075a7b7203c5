#pragma once

#include <vector>

#include "gpu/device/vulkan.hpp"

namespace heliograph::gpu {

/// Which ray tracing extensions a device has, each whole: the extensions and features it depends on
/// are there too.
struct RayExtensions {
  bool query = false;     // VK_KHR_ray_query
  bool pipeline = false;  // VK_KHR_ray_tracing_pipeline
};

/// What `device` offers; it must know Vulkan 1.3.
RayExtensions find_ray_extensions(VkPhysicalDevice device);

/// What to ask for at the creation of a device so that it has the extensions of `requested`.
class RayFeatures {
 public:
  explicit RayFeatures(const RayExtensions& requested);
  RayFeatures(const RayFeatures&) = delete;
  RayFeatures& operator=(const RayFeatures&) = delete;

  const std::vector<const char*>& extensions() const { return extensions_; }
  /// The first of a chain of feature structures, or null; lives as long as this.
  void* chain() const { return chain_; }

 private:
  VkPhysicalDeviceAccelerationStructureFeaturesKHR structure_{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR};
  VkPhysicalDeviceRayQueryFeaturesKHR query_{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR};
  VkPhysicalDeviceRayTracingPipelineFeaturesKHR pipeline_{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_FEATURES_KHR};
  std::vector<const char*> extensions_;
  void* chain_ = nullptr;
};

}  // namespace heliograph::gpu
