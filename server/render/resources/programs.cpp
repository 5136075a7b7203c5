#include "render/resources/programs.hpp"

#include <cstddef>

#include "render/resources/gbuffer_formats.hpp"
#include "render/resources/scene_set.hpp"
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
          {9, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}};
}

std::vector<gpu::DescriptorLayout::Binding> material_bindings(bool layered) {
  std::vector<gpu::DescriptorLayout::Binding> bindings;
  const auto add = [&](std::uint32_t textures) {
    for (std::uint32_t i = 0; i < textures; ++i) {
      const auto number = static_cast<std::uint32_t>(bindings.size());
      bindings.push_back({number, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER});
    }
    const auto number = static_cast<std::uint32_t>(bindings.size());
    bindings.push_back({number, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER});
  };
  add(material_textures);
  if (layered) add(shared::layer_textures);
  return bindings;
}

gpu::RasterState gbuffer_state(bool layered) {
  using shared::Vertex;
  gpu::RasterState state;
  state.color_formats.assign(gbuffer_formats.begin(), gbuffer_formats.end());
  if (layered) state.color_formats.push_back(gbuffer_layers_format);
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
      scene_layout(device, "scene", scene_bindings()),
      material_layout_(device, "material", material_bindings(false)),
      layered_material_layout_(device, "layered material", material_bindings(true)),
      gbuffer_(device, shaders::gbuffer_vert, shaders::gbuffer_frag, gbuffer_state(false),
               {{frame_set, &frame_layout}, {material_set, &material_layout_}}),
      gbuffer_masked_(device, shaders::gbuffer_vert, shaders::gbuffer_masked_frag,
                      gbuffer_state(false),
                      {{frame_set, &frame_layout}, {material_set, &material_layout_}}),
      device_(device) {}

const gpu::RasterProgram& Programs::gbuffer(std::uint32_t features, bool masked) const {
  if (!(features & shared::scene_layers)) return masked ? gbuffer_masked_ : gbuffer_;
  const std::lock_guard lock(mutex_);
  auto& program = layered_gbuffer_[masked];
  if (!program) {
    const gpu::ShaderBinary& fragment =
        masked ? shaders::gbuffer_layered_masked_frag : shaders::gbuffer_layered_frag;
    const gpu::SharedLayouts layouts{{frame_set, &frame_layout},
                                     {material_set, &layered_material_layout_}};
    program = std::make_unique<gpu::RasterProgram>(device_, shaders::gbuffer_vert, fragment,
                                                   gbuffer_state(true), layouts);
  }
  return *program;
}

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
