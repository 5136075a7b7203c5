#include "render/resources/light_table.hpp"

#include <algorithm>
#include <cstring>

namespace heliograph::render {

static_assert(sizeof(shared::Light) == shared::texels_per_light * 16);
static_assert(sizeof(shared::Light) * shared::uniform_lights <= 16384);

gpu::Buffer make_light_table(const gpu::Device& device, std::size_t count) {
  const std::size_t room = std::max<std::size_t>(count, shared::uniform_lights);
  gpu::Buffer table(device, "lights", room * sizeof(shared::Light),
                    VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT |
                        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                    gpu::Memory::upload);
  // Made now: several renderers on several threads share a scene's table.
  table.texel_view(light_texel_format);
  return table;
}

void write_lights(const gpu::Buffer& table, std::span<const shared::Light> lights) {
  std::memcpy(table.mapped(), lights.data(), lights.size_bytes());
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
    light.color = glm::vec3(frame.sun_irradiance);
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

}  // namespace heliograph::render
