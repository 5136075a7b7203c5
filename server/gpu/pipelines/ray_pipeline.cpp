#include "gpu/pipelines/ray_pipeline.hpp"

#include <array>
#include <cstring>
#include <vector>

#include "gpu/pipelines/shader_module.hpp"

namespace heliograph::gpu {
namespace {

constexpr std::uint32_t group_count = 3;  // generation, miss, hit

VkDeviceSize aligned(VkDeviceSize size, VkDeviceSize alignment) {
  return (size + alignment - 1) / alignment * alignment;
}

VkPhysicalDeviceRayTracingPipelinePropertiesKHR pipeline_properties(const Device& device) {
  VkPhysicalDeviceRayTracingPipelinePropertiesKHR rays{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_PROPERTIES_KHR};
  VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &rays};
  vkGetPhysicalDeviceProperties2(device.physical(), &properties);
  return rays;
}

VkRayTracingShaderGroupCreateInfoKHR group(VkRayTracingShaderGroupTypeKHR type,
                                           std::uint32_t general, std::uint32_t closest_hit,
                                           std::uint32_t any_hit) {
  VkRayTracingShaderGroupCreateInfoKHR info{
      VK_STRUCTURE_TYPE_RAY_TRACING_SHADER_GROUP_CREATE_INFO_KHR};
  info.type = type;
  info.generalShader = general;
  info.closestHitShader = closest_hit;
  info.anyHitShader = any_hit;
  info.intersectionShader = VK_SHADER_UNUSED_KHR;
  return info;
}

}  // namespace

RayProgram::RayProgram(const Device& device, const RayStages& stages, const SharedLayouts& shared)
    : Program(device, {stages.generation, stages.miss, stages.closest_hit, stages.any_hit},
              stages.generation.name) {
  const ProgramRegistry::Lock lock = device.programs().lock();
  const auto binaries = current_stages();
  const std::array reflections{reflect(binaries[0]), reflect(binaries[1]), reflect(binaries[2]),
                               reflect(binaries[3])};
  create_layout(reflections,
                VK_SHADER_STAGE_RAYGEN_BIT_KHR | VK_SHADER_STAGE_MISS_BIT_KHR |
                    VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR | VK_SHADER_STAGE_ANY_HIT_BIT_KHR,
                shared);
  pipeline_ = make_pipeline(binaries);
  write_table();
  registered_.enter(device.programs(), *this);
}

VkPipeline RayProgram::make_pipeline(std::span<const ShaderBinary> stages) const {
  const ShaderModule generation(device_, stages[0]);
  const ShaderModule miss(device_, stages[1]);
  const ShaderModule closest_hit(device_, stages[2]);
  const ShaderModule any_hit(device_, stages[3]);
  const std::array infos{generation.stage(VK_SHADER_STAGE_RAYGEN_BIT_KHR),
                         miss.stage(VK_SHADER_STAGE_MISS_BIT_KHR),
                         closest_hit.stage(VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR),
                         any_hit.stage(VK_SHADER_STAGE_ANY_HIT_BIT_KHR)};
  constexpr std::uint32_t none = VK_SHADER_UNUSED_KHR;
  const std::array<VkRayTracingShaderGroupCreateInfoKHR, group_count> groups{
      group(VK_RAY_TRACING_SHADER_GROUP_TYPE_GENERAL_KHR, 0, none, none),
      group(VK_RAY_TRACING_SHADER_GROUP_TYPE_GENERAL_KHR, 1, none, none),
      group(VK_RAY_TRACING_SHADER_GROUP_TYPE_TRIANGLES_HIT_GROUP_KHR, none, 2, 3)};
  VkRayTracingPipelineCreateInfoKHR info{VK_STRUCTURE_TYPE_RAY_TRACING_PIPELINE_CREATE_INFO_KHR};
  info.stageCount = static_cast<std::uint32_t>(infos.size());
  info.pStages = infos.data();
  info.groupCount = group_count;
  info.pGroups = groups.data();
  info.maxPipelineRayRecursionDepth = 1;
  info.layout = layout();
  VkPipeline pipeline = VK_NULL_HANDLE;
  check(vkCreateRayTracingPipelinesKHR(device_.handle(), VK_NULL_HANDLE, device_.pipeline_cache(),
                                       1, &info, nullptr, &pipeline),
        ("create the pipeline " + name()).c_str());
  device_.name(VK_OBJECT_TYPE_PIPELINE, pipeline, name());
  return pipeline;
}

void RayProgram::use_newest() {
  Program::use_newest();
  write_table();
}

void RayProgram::write_table() {
  const auto properties = pipeline_properties(device_);
  const VkDeviceSize handle = properties.shaderGroupHandleSize;
  const VkDeviceSize base = properties.shaderGroupBaseAlignment;
  const VkDeviceSize region = aligned(handle, base);
  std::vector<std::byte> handles(group_count * handle);
  check(vkGetRayTracingShaderGroupHandlesKHR(device_.handle(), pipeline_, 0, group_count,
                                             handles.size(), handles.data()),
        "read a pipeline's shader handles");
  table_ = Buffer(
      device_, name() + ".table", group_count * region + base,
      VK_BUFFER_USAGE_SHADER_BINDING_TABLE_BIT_KHR | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT,
      Memory::upload);
  const VkDeviceAddress address = table_.address();
  const VkDeviceSize shift = aligned(address, base) - address;
  const std::array regions{&generation_, &miss_, &hit_};
  for (std::size_t i = 0; i < group_count; ++i) {
    const VkDeviceSize offset = shift + i * region;
    std::memcpy(table_.mapped() + offset, handles.data() + i * handle, handle);
    *regions[i] = {address + offset, region, region};
  }
}

void RayProgram::launch(VkCommandBuffer commands, std::uint32_t count) const {
  const VkStridedDeviceAddressRegionKHR callable{};
  vkCmdTraceRaysKHR(commands, &generation_, &miss_, &hit_, &callable, count, 1, 1);
}

}  // namespace heliograph::gpu
