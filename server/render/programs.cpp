#include "render/programs.hpp"

#include <cstddef>

#include "render/gbuffer.hpp"
#include "render/scene_set.hpp"
#include "shaders/embedded.hpp"
#include "shaders/shared/scene.h"

namespace heliograph::render {
namespace {

std::vector<gpu::DescriptorLayout::Binding> frame_bindings() {
  return {{0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},
          {1, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},
          {2, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER},
          {3, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER},
          {4, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER},
          {5, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER},
          {6, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER},
          {7, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER},
          {8, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER},
          {9, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER}};
}

std::vector<gpu::DescriptorLayout::Binding> material_bindings() {
  std::vector<gpu::DescriptorLayout::Binding> bindings;
  for (std::uint32_t i = 0; i < material_textures; ++i) {
    bindings.push_back({i, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER});
  }
  bindings.push_back({material_textures, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER});
  return bindings;
}

gpu::RasterState gbuffer_state() {
  using shared::Vertex;
  gpu::RasterState state;
  state.color_formats.assign(GBuffer::formats.begin(), GBuffer::formats.end());
  state.depth_format = VK_FORMAT_D32_SFLOAT;
  // The same vertices now and one frame ago.
  state.vertex_bindings = {{0, sizeof(Vertex), VK_VERTEX_INPUT_RATE_VERTEX},
                           {1, sizeof(Vertex), VK_VERTEX_INPUT_RATE_VERTEX}};
  state.vertex_attributes = {
      {0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, position)},
      {1, 0, VK_FORMAT_R16G16_UNORM, offsetof(Vertex, color_rg)},
      {2, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, normal)},
      {3, 0, VK_FORMAT_R16G16_UNORM, offsetof(Vertex, color_ba)},
      {4, 0, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(Vertex, tangent)},
      {5, 0, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(Vertex, uv0)},
      {6, 1, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, position)},
  };
  return state;
}

}  // namespace

Programs::Programs(const gpu::Device& device)
    : frame_layout(device, "frame", frame_bindings()),
      material_layout(device, "material", material_bindings()),
      scene_layout(device, "scene", scene_bindings()),
      gbuffer(device, shaders::gbuffer_vert, shaders::gbuffer_frag, gbuffer_state(),
              {{frame_set, &frame_layout}, {material_set, &material_layout}}),
      gbuffer_masked(device, shaders::gbuffer_vert, shaders::gbuffer_masked_frag, gbuffer_state(),
                     {{frame_set, &frame_layout}, {material_set, &material_layout}}),
      device_(device) {}

const gpu::ComputeProgram& Programs::compute(const gpu::ShaderBinary& shader,
                                             std::uint32_t features) const {
  const std::lock_guard lock(mutex_);
  auto& program = compute_[{&shader, features}];
  if (!program) {
    const gpu::SharedLayouts layouts{{frame_set, &frame_layout}, {scene_set, &scene_layout}};
    program = std::make_unique<gpu::ComputeProgram>(device_, shader, layouts, features);
  }
  return *program;
}

}  // namespace heliograph::render
