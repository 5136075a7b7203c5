#include "render/passes/gbuffer/draw_camera_rays.hpp"

#include "render/passes/formats.hpp"
#include "render/passes/gbuffer/trace_gbuffer.hpp"
#include "render/passes/gbuffer/walked_buffers.hpp"
#include "shaders/shared/drawn.h"

namespace heliograph::render {
namespace {

/// With fewer triangles tracing is as fast. An H200's frames of 1920x1080 took, traced and drawn,
/// 2.12 and 2.15 ms with 74 triangles, 2.34 and 2.27 with 122 that fill the frame, 4.30 and 4.05
/// with 345,000.
constexpr std::uint32_t least_triangles = 100;
/// Every device can start 65,535 groups in a row.
constexpr std::uint32_t most_triangles = 65535 * 64;
/// Enough to fill a large device several times; each draws one part after the other.
constexpr std::uint32_t groups_of_parts = 8192;
/// Bytes in front of the first part: how many there are, and groups that trace in its place.
constexpr VkDeviceSize list_header = 16;
constexpr VkDeviceSize trace_groups_offset = 4;

/// shaders/gbuffer/gbuffer_clear.comp
template <class Stage>
struct GBufferClearBindings {
  gpu::WriteBuffer<Stage, std::uint64_t> nearest;
  gpu::WriteBuffer<Stage, shared::DrawnPart> parts;
};

/// shaders/gbuffer/gbuffer_small.comp and gbuffer_large.comp: what they have in common.
template <class Stage>
struct DrawnTriangles {
  WalkedBuffers<Stage> hierarchy;
  gpu::ReadWriteBuffer<Stage, std::uint64_t> nearest;
};
template <class Stage>
struct GBufferSmallBindings {
  DrawnTriangles<Stage> drawn;
  gpu::ReadWriteBuffer<Stage, shared::DrawnPart> parts;
};
struct GBufferSmallConstants {
  std::uint32_t first_slot;
  std::uint32_t slots;
  std::uint32_t most_parts;
};
template <class Stage>
struct GBufferLargeBindings {
  DrawnTriangles<Stage> drawn;
  gpu::ReadBuffer<Stage, shared::DrawnPart> parts;
};

/// shaders/gbuffer/gbuffer_drawn.comp and gbuffer_drawn_beside.comp
template <class Stage>
struct GBufferDrawnBindings {
  DrawnTriangles<Stage> drawn;
  gpu::WriteBuffer<Stage, shared::Hit> hits;
};

}  // namespace

void draw_camera_rays(gpu::FramePlan& plan, const FrameInputs& in,
                      const tracing::WalkedHierarchy& hierarchy, gpu::BufferRef hits,
                      std::uint32_t most_parts) {
  const VkExtent2D extent = plan.extent();
  const std::uint32_t rays =
      camera_ray_capacity(extent.width, {0, static_cast<int>(extent.height)});
  const gpu::BufferRef nearest = plan.buffer("gbuffer.nearest", sizeof(std::uint64_t) * rays,
                                             formats::storage, gpu::Memory::device);
  const DrawnTriangles<gpu::Declared> drawn{.hierarchy = walked_buffers(plan, hierarchy),
                                            .nearest = nearest};
  const gpu::BufferRef parts =
      plan.buffer("gbuffer.parts", list_header + sizeof(shared::DrawnPart) * most_parts,
                  formats::storage | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT, gpu::Memory::device);
  plan.pass("gbuffer.clear", in.program(shaders::gbuffer_clear))
      .bind<GBufferClearBindings>({.nearest = nearest, .parts = parts})
      .dispatch(gpu::each_pixel().reduced(2));
  plan.pass("gbuffer.small", in.program(shaders::gbuffer_small))
      .bind<GBufferSmallBindings>({.drawn = drawn, .parts = parts})
      .constants(GBufferSmallConstants{hierarchy.flat.first, hierarchy.flat.count, most_parts})
      .dispatch({hierarchy.flat.count, 1});
  plan.pass("gbuffer.large", in.program(shaders::gbuffer_large))
      .bind<GBufferLargeBindings>({.drawn = drawn, .parts = parts})
      .constants(most_parts)
      .dispatch({groups_of_parts * 32, 1});
  const bool all = hierarchy.flat.all;
  gpu::PassBuilder pass = plan.pass(
      "gbuffer.drawn", in.program(all ? shaders::gbuffer_drawn : shaders::gbuffer_drawn_beside));
  pass.bind<GBufferDrawnBindings>({.drawn = drawn, .hits = hits}).dispatch(gpu::each_pixel());
  if (!all) pass.constants(hierarchy.root);
  trace_camera_rays(plan, in, hierarchy, drawn.hierarchy, hits)
      .dispatch_indirect(parts, trace_groups_offset);
}

std::uint32_t most_drawn_parts(VkExtent2D extent) {
  const std::uint32_t side = shared::drawn_part_side;
  const std::uint32_t squares =
      ((extent.width + side - 1) / side) * ((extent.height + side - 1) / side);
  return 64 * squares + (1u << 18);
}

bool draws_camera_rays(const gpu::FramePlan& plan, const FrameInputs& in,
                       const tracing::WalkedHierarchy& hierarchy) {
  if (in.settings.gbuffer.source == protocol::PrimaryVisibility::rays) return false;
  return plan.device().atomics_64() && hierarchy.flat.count >= least_triangles &&
         hierarchy.flat.count <= most_triangles;
}

}  // namespace heliograph::render
