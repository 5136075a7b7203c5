#pragma once

#include "gpu/memory/buffer.hpp"
#include "gpu/pipelines/shader.hpp"

namespace heliograph::gpu {

/// The stages of a ray tracing pipeline. Every triangle of every mesh uses the same two hit stages.
struct RayStages {
  ShaderBinary generation;
  ShaderBinary miss;
  ShaderBinary closest_hit;
  ShaderBinary any_hit;
};

/// A VK_KHR_ray_tracing_pipeline pipeline with its shader binding table. No recursion: only the
/// generation stage traces.
class RayProgram : public Program {
 public:
  /// @throws GpuError when a shared layout lacks or contradicts what the shaders declare
  RayProgram(const Device& device, const RayStages& stages, const SharedLayouts& shared = {});

  /// Records `count` invocations of the generation stage, in one row. The pipeline is bound.
  void launch(VkCommandBuffer commands, std::uint32_t count) const;

  VkPipeline make_pipeline(std::span<const ShaderBinary> stages) const final;
  void use_newest() override;

 private:
  void write_table();

  Buffer table_;
  VkStridedDeviceAddressRegionKHR generation_{};
  VkStridedDeviceAddressRegionKHR miss_{};
  VkStridedDeviceAddressRegionKHR hit_{};
  RegisteredProgram registered_;
};

}  // namespace heliograph::gpu
