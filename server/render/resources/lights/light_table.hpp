#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gpu/memory/buffer.hpp"
#include "render/resources/lights/light_grid.hpp"
#include "shaders/shared/frame_constants.h"
#include "shaders/shared/scene.h"

namespace heliograph::render {

inline constexpr VkFormat light_texel_format = VK_FORMAT_R32G32B32A32_UINT;

/// The bits of shared::scene_* that follow from the lights.
std::uint32_t light_features(std::span<const shared::Light> lights);

/// A table of any number of lights as shaders/lib/lighting/lights.glsl reads it: the first
/// shared::uniform_lights from a uniform block, the others as texels of four words.
/// Where there are many, a grid follows them (shaders/shared/light_grid.h).
gpu::Buffer make_light_table(const gpu::Device& device, std::span<const shared::Light> lights);

/// Fills a table made for as many of the same kinds; `bounds` of the scene that they light. Never
/// while a frame runs that reads it.
void write_lights(const gpu::Buffer& table, std::span<const shared::Light> lights,
                  const scene::Bounds& bounds);

/// The lights of a frame as light_number() of shaders/lib/lighting/lights.glsl gives them, the
/// environment's sun last, from a table that the host can reach.
std::vector<shared::Light> frame_lights(const gpu::Buffer& table,
                                        const shared::FrameConstants& frame);

/// The same with the grid of a scene with `features`, if the frame chooses lights by one. Refers to
/// the table.
class FrameLights {
 public:
  FrameLights(const gpu::Buffer& table, const shared::FrameConstants& frame,
              std::uint32_t features);

  kernels::SceneLights view() const { return {all_, outside_, grid_, entries_, slots_}; }
  /// Those that no cell of the grid lists.
  std::vector<shared::Light> outside() const;

 private:
  std::vector<shared::Light> all_;
  std::vector<std::uint32_t> outside_;
  const shared::LightGridHeader* grid_ = nullptr;
  const shared::LightEntry* entries_ = nullptr;
  const shared::LightSlot* slots_ = nullptr;
};

}  // namespace heliograph::render
