#include "render/gbuffer.hpp"

#include "render/frame.hpp"
#include "render/frustum.hpp"

namespace heliograph::render {
namespace {

/// Binds what differs from the draw before, then draws.
class DrawRecorder {
 public:
  DrawRecorder(const FrameInputs& in, VkCommandBuffer commands, VkPipelineLayout layout)
      : in_(in), commands_(commands), layout_(layout) {
    const VkDeviceSize offset = 0;
    const VkBuffer vertices = in.tables.vertices.handle();
    vkCmdBindVertexBuffers(commands, 0, 1, &vertices, &offset);
    vkCmdBindIndexBuffer(commands, in.tables.indices.handle(), 0, VK_INDEX_TYPE_UINT32);
    vkCmdSetCullMode(commands, VK_CULL_MODE_BACK_BIT);
    vkCmdSetFrontFace(commands, VK_FRONT_FACE_COUNTER_CLOCKWISE);
  }

  void draw(const Draw& draw) {
    if (draw.masked != masked_) {
      masked_ = draw.masked;
      const auto& program = masked_ ? in_.programs.gbuffer_masked : in_.programs.gbuffer;
      vkCmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_GRAPHICS, program.pipeline());
    }
    if (draw.material != material_) {
      material_ = draw.material;
      vkCmdBindDescriptorSets(commands_, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_, material_set, 1,
                              &in_.scene.material_sets[material_], 0, nullptr);
    }
    vkCmdPushConstants(commands_, layout_,
                       VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                       sizeof draw.constants, &draw.constants);
    vkCmdSetCullMode(commands_, draw.double_sided ? VK_CULL_MODE_NONE : VK_CULL_MODE_BACK_BIT);
    vkCmdSetFrontFace(commands_,
                      draw.flipped ? VK_FRONT_FACE_CLOCKWISE : VK_FRONT_FACE_COUNTER_CLOCKWISE);
    vkCmdDrawIndexed(commands_, draw.index_count, 1, draw.first_index,
                     static_cast<std::int32_t>(draw.first_vertex), 0);
  }

 private:
  const FrameInputs& in_;
  VkCommandBuffer commands_;
  VkPipelineLayout layout_;
  bool masked_ = false;
  std::uint32_t material_ = ~0u;
};

}  // namespace

GBuffer rasterize_gbuffer(gpu::FramePlan& plan, const FrameInputs& in) {
  constexpr VkImageUsageFlags attachment = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  const auto signal = [&](const char* name, std::size_t index) {
    return plan.image(name, GBuffer::formats[index], attachment);
  };
  const auto remembered = [&](const char* name, std::size_t index, gpu::ImageRef& previous) {
    const gpu::History history = plan.history(name, GBuffer::formats[index], attachment);
    previous = history.previous;
    return history.current;
  };
  GBuffer gbuffer;
  gbuffer.normals = remembered("gbuffer.normals", 0, gbuffer.previous_normals);
  gbuffer.base_color = signal("gbuffer.base_color", 1);
  gbuffer.surface = remembered("gbuffer.surface", 2, gbuffer.previous_surface);
  gbuffer.motion = remembered("gbuffer.motion", 3, gbuffer.previous_motion);
  gbuffer.emissive = signal("gbuffer.emissive", 4);
  gbuffer.depth_slope = signal("gbuffer.depth_slope", 5);
  gbuffer.instance = remembered("gbuffer.instance", 6, gbuffer.previous_instance);
  gbuffer.depth = plan.image("gbuffer.depth", VK_FORMAT_D32_SFLOAT);

  constexpr std::array<float, 4> nothing{};
  plan.raster("gbuffer", in.programs.gbuffer)
      .color(gbuffer.normals, nothing)
      .color(gbuffer.base_color, nothing)
      .color(gbuffer.surface, nothing)
      .color(gbuffer.motion, nothing)
      .color(gbuffer.emissive, nothing)
      .color(gbuffer.depth_slope, nothing)
      .color(gbuffer.instance, nothing)
      .depth(gbuffer.depth, 0.0f)
      .constants(shared::DrawConstants{})  // every draw pushes its own
      .draw([in](VkCommandBuffer commands, VkPipelineLayout layout) {
        const Frustum frustum(in.constants.view_projection);
        DrawRecorder recorder(in, commands, layout);
        for (const Draw& draw : in.scene.draws) {
          if (frustum.may_contain(draw.bounds)) recorder.draw(draw);
        }
      });
  return gbuffer;
}

}  // namespace heliograph::render
