#include "render/resources/lights/light_table.hpp"

#include <algorithm>
#include <numeric>

namespace heliograph::render {

static_assert(sizeof(shared::Light) == shared::texels_per_light * 16);
static_assert(sizeof(shared::Light) * shared::uniform_lights <= 16384);

namespace {

/// Of the grid, behind the lights.
std::size_t first_grid_texel(std::size_t lights) {
  return std::max<std::size_t>(lights, shared::uniform_lights) * shared::texels_per_light;
}

}  // namespace

std::uint32_t light_features(std::span<const shared::Light> lights) {
  const bool areas = std::ranges::any_of(
      lights, [](const shared::Light& light) { return light.type >= shared::light_rectangle; });
  return (areas ? shared::scene_area_lights : 0u) |
         (lights.size() > shared::uniform_lights ? shared::scene_many_lights : 0u) |
         (needs_light_grid(lights) ? shared::scene_light_grid : 0u);
}

gpu::Buffer make_light_table(const gpu::Device& device, std::span<const shared::Light> lights) {
  std::size_t texels = first_grid_texel(lights.size());
  if (needs_light_grid(lights)) texels += light_grid_texels(lights);
  gpu::Buffer table(device, "lights", texels * light_texel,
                    VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT |
                        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                    gpu::Memory::upload);
  // Made now: several renderers on several threads share a scene's table.
  table.texel_view(light_texel_format);
  return table;
}

void write_lights(const gpu::Buffer& table, std::span<const shared::Light> lights,
                  const scene::Bounds& bounds) {
  std::ranges::copy(std::as_bytes(lights), table.mapped());  // none has no address
  if (!needs_light_grid(lights)) return;
  write_light_grid(lights, bounds, table.mapped(), first_grid_texel(lights.size()));
}

std::vector<shared::Light> frame_lights(const gpu::Buffer& table,
                                        const shared::FrameConstants& frame) {
  const bool sun = frame.sun_radius >= 0.0f;
  const std::size_t count = frame.light_count - (sun ? 1u : 0u);
  const auto* first = reinterpret_cast<const shared::Light*>(table.mapped());
  std::vector<shared::Light> lights(first, first + count);
  if (sun) {
    shared::Light light{};
    light.type = shared::light_directional;
    light.direction = -frame.sun_direction;
    light.color = frame.sun_irradiance;
    light.radius = frame.sun_radius;
    lights.push_back(light);
  }
  for (shared::Light& light : lights) {
    const bool overridden =
        light.type == shared::light_directional && frame.directional_light_radius >= 0.0f;
    if (overridden) light.radius = frame.directional_light_radius;
  }
  return lights;
}

FrameLights::FrameLights(const gpu::Buffer& table, const shared::FrameConstants& frame,
                         std::uint32_t features)
    : all_(frame_lights(table, frame)) {
  const bool sun = frame.sun_radius >= 0.0f;
  const std::size_t of_scene = all_.size() - (sun ? 1 : 0);
  if ((features & shared::scene_light_grid) == 0 || (frame.flags & shared::frame_light_grid) == 0) {
    outside_.resize(all_.size());
    std::iota(outside_.begin(), outside_.end(), 0u);
    return;
  }
  const std::byte* const begin = table.mapped();
  const auto at = [begin](std::size_t first) { return begin + first * light_texel; };
  grid_ = reinterpret_cast<const shared::LightGridHeader*>(at(first_grid_texel(of_scene)));
  entries_ = reinterpret_cast<const shared::LightEntry*>(at(grid_->first_entry));
  slots_ = reinterpret_cast<const shared::LightSlot*>(at(grid_->first_slot));
  const auto* const outside = reinterpret_cast<const glm::uvec4*>(at(grid_->first_outside));
  for (std::uint32_t i = 0; i < grid_->outside_count; ++i) outside_.push_back(outside[i].x);
  if (sun) outside_.push_back(static_cast<std::uint32_t>(of_scene));
}

std::vector<shared::Light> FrameLights::outside() const {
  std::vector<shared::Light> lights;
  for (const std::uint32_t number : outside_) lights.push_back(all_[number]);
  return lights;
}

}  // namespace heliograph::render
