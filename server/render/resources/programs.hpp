#pragma once

#include <array>
#include <map>
#include <memory>
#include <mutex>

#include "gpu/pipelines/shader.hpp"

namespace heliograph::render {

/// Set 0: the frame's constants and the scene's small tables (shaders/lib/frame.glsl).
inline constexpr std::uint32_t frame_set = 0;
/// Set 2: the five textures of one material, then its values
/// (shaders/lib/scene/gbuffer_surface.glsl); in scenes with layers the textures and values of its
/// layer after them.
inline constexpr std::uint32_t material_set = 2;
inline constexpr std::uint32_t material_textures = 5;
/// Set 3: the whole scene, for compute shaders (shaders/lib/scene/scene_tables.glsl).
inline constexpr std::uint32_t scene_set = 3;

/// Every program of the renderer, made once per device, each when it is first asked for.
class Programs {
 public:
  explicit Programs(const gpu::Device& device);

  /// The compute program of an embedded shader. Thread safe; the reference lives as long as this.
  /// `features` are the shared::scene_* bits of what the scene has: a shader made for a scene
  /// without area lights, say, has no code for them, which lavapipe would run, masked, for every
  /// pixel.
  const gpu::ComputeProgram& compute(const gpu::ShaderBinary& shader,
                                     std::uint32_t features = ~0u) const;

  /// Draws the G-buffer of a scene with these features; `masked` surfaces may have holes.
  const gpu::RasterProgram& gbuffer(std::uint32_t features, bool masked) const;

  const gpu::DescriptorLayout& material_layout(bool layered) const {
    return layered ? layered_material_layout_ : material_layout_;
  }

  gpu::DescriptorLayout frame_layout;
  gpu::DescriptorLayout scene_layout;

 private:
  gpu::DescriptorLayout material_layout_;
  gpu::DescriptorLayout layered_material_layout_;
  gpu::RasterProgram gbuffer_;
  gpu::RasterProgram gbuffer_masked_;
  const gpu::Device& device_;
  mutable std::mutex mutex_;
  using Key = std::pair<const gpu::ShaderBinary*, std::uint32_t>;
  mutable std::map<Key, std::unique_ptr<gpu::ComputeProgram>> compute_;
  mutable std::array<std::unique_ptr<gpu::RasterProgram>, 2> layered_gbuffer_;  // by `masked`
};

}  // namespace heliograph::render
