#include "render/passes/gbuffer/gbuffer.hpp"

#include "render/passes/frame_inputs.hpp"
#include "render/passes/gbuffer/frustum.hpp"
#include "render/resources/gbuffer_formats.hpp"
#include "render/resources/moving/moving_scene.hpp"

namespace heliograph::render {
namespace {

/// Binds what differs from the draw before, then draws.
class DrawRecorder {
 public:
  DrawRecorder(const FrameInputs& in, VkCommandBuffer commands, VkPipelineLayout layout)
      : in_(in), material_sets_(in.moving.material_sets()), commands_(commands), layout_(layout) {
    vkCmdBindIndexBuffer(commands, in.tables.indices.handle(), 0, VK_INDEX_TYPE_UINT32);
    vkCmdSetCullMode(commands, VK_CULL_MODE_BACK_BIT);
    vkCmdSetFrontFace(commands, VK_FRONT_FACE_COUNTER_CLOCKWISE);
  }

  void draw(const Draw& draw) {
    if (draw.masked != masked_) {
      masked_ = draw.masked;
      const auto& program = in_.programs.gbuffer(in_.moving.features_without_emission(), masked_);
      vkCmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_GRAPHICS, program.pipeline());
    }
    if (draw.material != material_) {
      material_ = draw.material;
      vkCmdBindDescriptorSets(commands_, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_, material_set, 1,
                              &material_sets_[material_], 0, nullptr);
    }
    vkCmdPushConstants(commands_, layout_,
                       VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                       sizeof draw.constants, &draw.constants);
    vkCmdSetCullMode(commands_, draw.double_sided ? VK_CULL_MODE_NONE : VK_CULL_MODE_BACK_BIT);
    vkCmdSetFrontFace(commands_,
                      draw.flipped ? VK_FRONT_FACE_CLOCKWISE : VK_FRONT_FACE_COUNTER_CLOCKWISE);
    bind_vertices(draw);
    const auto first_vertex =
        draw.previous_vertex ? 0 : static_cast<std::int32_t>(draw.first_vertex);
    vkCmdDrawIndexed(commands_, draw.index_count, 1, draw.first_index, first_vertex, 0);
  }

 private:
  // The second binding has the positions of the frame before: a table of their own for meshes that
  // deform, the vertices themselves for all others.
  void bind_vertices(const Draw& draw) {
    if (!draw.previous_vertex && shared_vertices_bound_) return;
    shared_vertices_bound_ = !draw.previous_vertex;
    std::array buffers{in_.tables.vertices.handle(), in_.tables.vertices.handle()};
    std::array<VkDeviceSize, 2> offsets{0, 0};
    if (draw.previous_vertex) {
      buffers[1] = in_.moving.previous_vertices().handle();
      offsets = {draw.first_vertex * sizeof(shared::Vertex),
                 *draw.previous_vertex * sizeof(shared::Vertex)};
    }
    vkCmdBindVertexBuffers(commands_, 0, 2, buffers.data(), offsets.data());
  }

  const FrameInputs& in_;
  const std::vector<VkDescriptorSet>& material_sets_;
  VkCommandBuffer commands_;
  VkPipelineLayout layout_;
  bool masked_ = false;
  std::uint32_t material_ = ~0u;
  bool shared_vertices_bound_ = false;
};

}  // namespace

GBuffer declare_gbuffer(gpu::FramePlan& plan, std::uint32_t features) {
  constexpr VkImageUsageFlags attachment = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  const auto image = [&](const BufferDescription& buffer, std::size_t index) {
    return plan.image(buffer.name, gbuffer_formats[index], attachment);
  };
  const auto history = [&](const BufferDescription& buffer, std::size_t index,
                           gpu::ImageRef& previous) {
    const gpu::History made = plan.history(buffer.name, gbuffer_formats[index], attachment);
    previous = made.previous;
    return made.current;
  };
  const auto& buffers = gbuffer_buffers;
  GBuffer gbuffer;
  gbuffer.normals = history(buffers.normals, 0, gbuffer.previous_normals);
  gbuffer.base_color = image(buffers.base_color, 1);
  gbuffer.surface = history(buffers.surface, 2, gbuffer.previous_surface);
  const bool layered = (features & shared::scene_layers) != 0;
  gbuffer.layers = plan.image("gbuffer.layers", gbuffer_layers_format, attachment,
                              layered ? gpu::each_pixel() : gpu::FrameSize(1, 1));
  gbuffer.motion = history(buffers.motion, 3, gbuffer.previous_motion);
  gbuffer.emissive = image(buffers.emissive, 4);
  gbuffer.depth_slope = image(buffers.depth_slope, 5);
  gbuffer.instance = history(buffers.instance, 6, gbuffer.previous_instance);
  return gbuffer;
}

GBuffer rasterize_gbuffer(gpu::FramePlan& plan, const FrameInputs& in) {
  in.moving.material_sets();  // before the first frame, which should not have to make them
  const GBuffer gbuffer = declare_gbuffer(plan, in.moving.features_without_emission());
  constexpr std::array<float, 4> nothing{};
  // Beyond the octahedron, whose middle is a normal like any other.
  constexpr std::array<float, 4> no_normal{2.0f, 2.0f, 2.0f, 2.0f};
  gpu::PassBuilder pass =
      plan.raster("gbuffer", in.programs.gbuffer(in.moving.features_without_emission(), false));
  pass.color(gbuffer.normals, no_normal)
      .color(gbuffer.base_color, nothing)
      .color(gbuffer.surface, nothing)
      .color(gbuffer.motion, nothing)
      .color(gbuffer.emissive, nothing)
      .color(gbuffer.depth_slope, nothing)
      .color(gbuffer.instance, nothing);
  if (in.moving.features_without_emission() & shared::scene_layers)
    pass.color(gbuffer.layers, nothing);
  pass.depth(plan.image("gbuffer.depth", VK_FORMAT_D32_SFLOAT), 0.0f)
      .constants(shared::DrawConstants{})  // every draw pushes its own
      .draw([in](VkCommandBuffer commands, VkPipelineLayout layout) {
        const Frustum frustum(in.constants.view_projection);
        DrawRecorder recorder(in, commands, layout);
        for (const Draw& draw : in.moving.draws()) {
          if (frustum.may_contain(draw.bounds)) recorder.draw(draw);
        }
      });
  return gbuffer;
}

}  // namespace heliograph::render
