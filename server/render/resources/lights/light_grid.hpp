#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/resources/lights/light_tree.hpp"
#include "scene/scene.hpp"
#include "shaders/shared/light_grid.h"
#include "shaders/shared/scene.h"

namespace heliograph::render {

namespace kernels {

/// The lights of a frame as host kernels read them.
struct SceneLights {
  std::span<const shared::Light> all;  // by number
  /// Numbers of those that no cell of the grid lists: all, where there is none.
  std::span<const std::uint32_t> outside;
  const shared::LightGridHeader* grid;  // null: there is none
  const shared::LightEntry* entries;
  const shared::LightSlot* slots;
};

}  // namespace kernels

/// Of the table of lights, bytes.
inline constexpr std::size_t light_texel = 16;

/// Whether a scene with these lights has a grid (shaders/shared/light_grid.h). It stays so, because
/// neither kinds nor number of a scene's lights change.
bool needs_light_grid(std::span<const shared::Light> lights);

/// Texels that the grid of any such lights takes.
std::size_t light_grid_texels(std::span<const shared::Light> lights);

/// Makes the grid of a scene within `bounds`, on all processors. `table`: of lights; `first`: the
/// texel of the table at which the grid begins, with room for light_grid_texels().
void write_light_grid(std::span<const shared::Light> lights, const scene::Bounds& bounds,
                      std::byte* table, std::size_t first);

}  // namespace heliograph::render
