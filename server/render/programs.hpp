#pragma once

#include "gpu/shader.hpp"

namespace heliograph::render {

/// Set 0: the frame's constants and the scene's tables (shaders/lib/frame.glsl).
inline constexpr std::uint32_t frame_set = 0;
/// Set 2: the five textures of one material, then its values (shaders/lib/gbuffer_surface.glsl).
inline constexpr std::uint32_t material_set = 2;
inline constexpr std::uint32_t material_textures = 5;

/// Every program of the renderer, made once per device.
struct Programs {
  explicit Programs(const gpu::Device& device);

  gpu::DescriptorLayout frame_layout;
  gpu::DescriptorLayout material_layout;

  gpu::ComputeProgram environment_cube;
  gpu::ComputeProgram cube_mip;
  gpu::ComputeProgram prefilter_environment;
  gpu::ComputeProgram split_sum_table;

  gpu::RasterProgram gbuffer;
  gpu::RasterProgram gbuffer_masked;
  gpu::ComputeProgram begin_rays;
  gpu::ComputeProgram shadow_rays;
  gpu::ComputeProgram ambient_rays;
  gpu::ComputeProgram resolve_visibility;
  gpu::ComputeProgram skybox;
  gpu::ComputeProgram compose;
  gpu::ComputeProgram accumulate;
  gpu::ComputeProgram present;
};

}  // namespace heliograph::render
