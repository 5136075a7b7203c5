#include "gpu/device/ray_extensions.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace heliograph::gpu {
namespace {

std::vector<VkExtensionProperties> device_extensions(VkPhysicalDevice device) {
  std::uint32_t count = 0;
  vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr);
  std::vector<VkExtensionProperties> found(count);
  if (vkEnumerateDeviceExtensionProperties(device, nullptr, &count, found.data()) < 0) return {};
  found.resize(count);
  return found;
}

}  // namespace

RayExtensions find_ray_extensions(VkPhysicalDevice device) {
  const std::vector<VkExtensionProperties> found = device_extensions(device);
  const auto has = [&](const char* name) {
    return std::any_of(found.begin(), found.end(), [name](const auto& extension) {
      return std::strcmp(extension.extensionName, name) == 0;
    });
  };
  if (!has(VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME) ||
      !has(VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME)) {
    return {};
  }
  VkPhysicalDeviceAccelerationStructureFeaturesKHR structure{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR};
  VkPhysicalDeviceRayQueryFeaturesKHR query{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR, &structure};
  VkPhysicalDeviceRayTracingPipelineFeaturesKHR pipeline{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_FEATURES_KHR, &query};
  VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &pipeline};
  vkGetPhysicalDeviceFeatures2(device, &features);
  if (!structure.accelerationStructure) return {};
  return {
      .query = has(VK_KHR_RAY_QUERY_EXTENSION_NAME) && query.rayQuery,
      .pipeline = has(VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME) && pipeline.rayTracingPipeline};
}

RayFeatures::RayFeatures(const RayExtensions& requested) {
  if (!requested.query && !requested.pipeline) return;
  structure_.accelerationStructure = VK_TRUE;
  chain_ = &structure_;
  extensions_ = {VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME,
                 VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME};
  if (requested.query) {
    query_.rayQuery = VK_TRUE;
    query_.pNext = chain_;
    chain_ = &query_;
    extensions_.push_back(VK_KHR_RAY_QUERY_EXTENSION_NAME);
  }
  if (requested.pipeline) {
    pipeline_.rayTracingPipeline = VK_TRUE;
    pipeline_.pNext = chain_;
    chain_ = &pipeline_;
    extensions_.push_back(VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME);
  }
}

}  // namespace heliograph::gpu
