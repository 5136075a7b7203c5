#include "render/frame/frame_set.hpp"

#include "render/resources/lights/light_table.hpp"

namespace heliograph::render {

void write_frame_set(const Engine::Parts& parts, VkDescriptorSet set, const gpu::Buffer& constants,
                     const gpu::Buffer& lights, const EnvironmentView& environment) {
  constexpr auto uniform = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
  gpu::DescriptorWriter(parts.device, set)
      .buffer(0, uniform, constants.handle())
      .buffer(1, uniform, lights.handle(), 0, sizeof(shared::Light) * shared::uniform_lights)
      .sampled_image(2, environment.maps.map.view(), parts.around.handle())
      .sampled_image(3, environment.maps.prefiltered.view(), parts.clamped.handle())
      .sampled_image(4, parts.split_sum_table.view(), parts.clamped.handle())
      .texel_buffer(5, lights.texel_view(light_texel_format))
      .sampled_image(6, parts.ltc_table.view(), parts.clamped.handle())
      .sampled_image(7, environment.background.view(), parts.around.handle())
      .texel_buffer(8, environment.maps.cells.texel_view(VK_FORMAT_R32G32B32A32_UINT))
      .sampled_image(9, parts.sheen_table.view(), parts.clamped.handle())
      .apply();
}

}  // namespace heliograph::render
