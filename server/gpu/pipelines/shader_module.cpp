#include "gpu/pipelines/shader_module.hpp"

namespace heliograph::gpu {

ShaderModule::ShaderModule(const Device& device, const ShaderBinary& shader) : device_(device) {
  VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
  info.codeSize = shader.words.size_bytes();
  info.pCode = shader.words.data();
  check(vkCreateShaderModule(device.handle(), &info, nullptr, &handle_), "load a shader");
}

ShaderModule::~ShaderModule() {
  vkDestroyShaderModule(device_.handle(), handle_, nullptr);
}

VkPipelineShaderStageCreateInfo ShaderModule::stage(VkShaderStageFlagBits bit) const {
  VkPipelineShaderStageCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
  info.stage = bit;
  info.module = handle_;
  info.pName = "main";
  return info;
}

}  // namespace heliograph::gpu
