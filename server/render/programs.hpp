#pragma once

#include <map>
#include <memory>
#include <mutex>

#include "gpu/shader.hpp"

namespace heliograph::render {

/// Set 0: the frame's constants and the scene's small tables (shaders/lib/frame.glsl).
inline constexpr std::uint32_t frame_set = 0;
/// Set 2: the five textures of one material, then its values (shaders/lib/gbuffer_surface.glsl).
inline constexpr std::uint32_t material_set = 2;
inline constexpr std::uint32_t material_textures = 5;
/// Set 3: the whole scene, for compute shaders (shaders/lib/scene_tables.glsl).
inline constexpr std::uint32_t scene_set = 3;

/// Every program of the renderer, made once per device, each when it is first asked for.
class Programs {
 public:
  explicit Programs(const gpu::Device& device);

  /// The compute program of an embedded shader. Thread safe; the reference lives as long as this.
  /// `features` are the shared::scene_* bits of what the scene has: a shader made for a scene without
  /// area lights, say, has no code for them, which lavapipe would run, masked, for every pixel.
  const gpu::ComputeProgram& compute(const gpu::ShaderBinary& shader,
                                     std::uint32_t features = ~0u) const;

  gpu::DescriptorLayout frame_layout;
  gpu::DescriptorLayout material_layout;
  gpu::DescriptorLayout scene_layout;

  gpu::RasterProgram gbuffer;
  gpu::RasterProgram gbuffer_masked;

 private:
  const gpu::Device& device_;
  mutable std::mutex mutex_;
  using Key = std::pair<const gpu::ShaderBinary*, std::uint32_t>;
  mutable std::map<Key, std::unique_ptr<gpu::ComputeProgram>> compute_;
};

}  // namespace heliograph::render
