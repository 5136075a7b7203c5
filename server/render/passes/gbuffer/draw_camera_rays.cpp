#include "render/passes/gbuffer/draw_camera_rays.hpp"

#include "render/passes/formats.hpp"
#include "render/passes/gbuffer/trace_gbuffer.hpp"
#include "shaders/embedded.hpp"
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
/// Each traces one tile after the other.
constexpr std::uint32_t groups_of_tiles = 4096;
constexpr VkDeviceSize count_size = sizeof(std::uint32_t);  // in front of a list

/// shaders/gbuffer/gbuffer_clear.comp
template <class Stage>
struct GBufferClearBindings {
  gpu::WriteBuffer<Stage, std::uint64_t> nearest;
  gpu::WriteBuffer<Stage, std::uint32_t> parts;
  gpu::WriteBuffer<Stage, std::uint32_t> tiles;
};

/// shaders/gbuffer/gbuffer_tiles.comp
template <class Stage>
struct GBufferTilesBindings {
  gpu::ReadBuffer<Stage, glm::vec4> records;
  gpu::ReadWriteBuffer<Stage, std::uint32_t> tiles;
  gpu::WriteBuffer<Stage, std::uint32_t> found_by;
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

/// shaders/gbuffer/gbuffer_beside.comp
template <class Stage>
struct GBufferBesideBindings {
  WalkedBuffers<Stage> hierarchy;
  gpu::ReadBuffer<Stage, shared::DrawnPart> parts;
  gpu::ReadBuffer<Stage, std::uint32_t> tiles;
  gpu::WriteBuffer<Stage, shared::Hit> traced;
  gpu::WriteBuffer<Stage, std::uint32_t> found_by;
};
struct GBufferBesideConstants {
  std::uint32_t root;
  std::uint32_t most_parts;
};

/// What the passes share.
struct Drawing {
  WalkedBuffers<gpu::Declared> hierarchy;
  gpu::BufferRef nearest;
  gpu::BufferRef parts;  // their number, then shared::DrawnPart each
  gpu::BufferRef tiles;  // likewise, numbers of tiles
  gpu::BufferRef traced;
  gpu::BufferRef found_by;
  std::uint32_t most_parts;

  DrawnTriangles<gpu::Declared> drawn() const { return {hierarchy, nearest}; }
};

Drawing declare_drawing(gpu::FramePlan& plan, const WalkedBuffers<gpu::Declared>& hierarchy,
                        gpu::BufferRef traced, std::uint32_t most_parts) {
  const VkExtent2D extent = plan.extent();
  const std::uint32_t rays =
      camera_ray_capacity(extent.width, {0, static_cast<int>(extent.height)});
  const auto buffer = [&](const char* name, VkDeviceSize size) {
    return plan.buffer(name, size, formats::storage, gpu::Memory::device);
  };
  const VkDeviceSize tiles = rays / shared::tile_pixels;
  return {.hierarchy = hierarchy,
          .nearest = buffer("gbuffer.nearest", sizeof(std::uint64_t) * rays),
          .parts = buffer("gbuffer.parts", count_size + sizeof(shared::DrawnPart) * most_parts),
          .tiles = buffer("gbuffer.tiles", count_size + sizeof(std::uint32_t) * tiles),
          .traced = traced,
          .found_by = buffer("gbuffer.found_by", sizeof(std::uint32_t) * tiles),
          .most_parts = most_parts};
}

/// Triangles of the flat tree.
void draw_triangles(gpu::FramePlan& plan, const FrameInputs& in, const Drawing& drawing,
                    const tracing::WalkedHierarchy::Flat& flat) {
  plan.pass("gbuffer.small", in.program(shaders::gbuffer_small))
      .bind<GBufferSmallBindings>({.drawn = drawing.drawn(), .parts = drawing.parts})
      .constants(GBufferSmallConstants{flat.first, flat.count, drawing.most_parts})
      .dispatch({flat.count, 1});
  plan.pass("gbuffer.large", in.program(shaders::gbuffer_large))
      .bind<GBufferLargeBindings>({.drawn = drawing.drawn(), .parts = drawing.parts})
      .constants(drawing.most_parts)
      .dispatch({groups_of_parts * 32, 1});
}

/// The rest of the scene.
void trace_beside(gpu::FramePlan& plan, const FrameInputs& in, const Drawing& drawing,
                  const tracing::WalkedHierarchy& hierarchy) {
  plan.pass("gbuffer.tiles", in.program(shaders::gbuffer_tiles))
      .bind<GBufferTilesBindings>({.records = drawing.hierarchy.records,
                                   .tiles = drawing.tiles,
                                   .found_by = drawing.found_by})
      .constants(hierarchy.upper_nodes)
      .dispatch(gpu::each_pixel().reduced(8));
  plan.pass("gbuffer.beside", in.program(shaders::gbuffer_beside))
      .bind<GBufferBesideBindings>({.hierarchy = drawing.hierarchy,
                                    .parts = drawing.parts,
                                    .tiles = drawing.tiles,
                                    .traced = drawing.traced,
                                    .found_by = drawing.found_by})
      .constants([root = hierarchy.root, most_parts = drawing.most_parts] {
        return GBufferBesideConstants{root(), most_parts};
      })
      .dispatch({groups_of_tiles * shared::tile_pixels, 1});
}

}  // namespace

DrawnHits<gpu::Declared> draw_camera_rays(gpu::FramePlan& plan, const FrameInputs& in,
                                          const tracing::WalkedHierarchy& hierarchy,
                                          const WalkedBuffers<gpu::Declared>& buffers,
                                          gpu::BufferRef traced, std::uint32_t most_parts) {
  const Drawing drawing = declare_drawing(plan, buffers, traced, most_parts);
  plan.pass("gbuffer.clear", in.program(shaders::gbuffer_clear))
      .bind<GBufferClearBindings>(
          {.nearest = drawing.nearest, .parts = drawing.parts, .tiles = drawing.tiles})
      .dispatch(gpu::each_pixel().reduced(2));
  draw_triangles(plan, in, drawing, hierarchy.flat);
  trace_beside(plan, in, drawing, hierarchy);
  return {.traced = drawing.traced, .nearest = drawing.nearest, .found_by = drawing.found_by};
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
