#pragma once

#include "gpu/pipelines/shader.hpp"

namespace heliograph::gpu {

/// A shader module that lives as long as the pipeline is being made.
class ShaderModule {
 public:
  ShaderModule(const Device& device, const ShaderBinary& shader);
  ~ShaderModule();
  ShaderModule(const ShaderModule&) = delete;
  ShaderModule& operator=(const ShaderModule&) = delete;

  VkPipelineShaderStageCreateInfo stage(VkShaderStageFlagBits bit) const;

 private:
  const Device& device_;
  VkShaderModule handle_ = VK_NULL_HANDLE;
};

}  // namespace heliograph::gpu
