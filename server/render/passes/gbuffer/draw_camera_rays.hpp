#pragma once

#include "render/passes/frame_inputs.hpp"
#include "render/passes/gbuffer/walked_buffers.hpp"
#include "shaders/shared/ray.h"
#include "tracing/ray_tracer.hpp"

namespace heliograph::render {

/// What camera rays meet first, drawn or traced: bindings from DRAWN_BINDING on of
/// shaders/lib/rays/drawn_hit.glsl, which finds it.
template <class Stage>
struct DrawnHits {
  gpu::ReadBuffer<Stage, shared::Hit> traced;
  gpu::ReadBuffer<Stage, std::uint64_t> nearest;
  gpu::ReadBuffer<Stage, std::uint32_t> found_by;
};

/// Adds the passes that find what the camera rays of all pixels meet first, like `gbuffer.trace`,
/// without tracing what does not move: triangles of the hierarchy's flat tree are drawn by
/// compute shaders, each intersected with the rays of the pixels that it covers, and the nearest
/// stays (Laine and Karras, HPG 2011; small ones by an invocation each, as Karis et al., SIGGRAPH
/// 2021). Backs of one-sided triangles, which camera rays go on through, are left out where no
/// mirror turns them, and so are holes that the filtered texels of masks have. The rest of the
/// scene is traced at the same time, into `traced`, of shared::Hit each, in tiles that the boxes of
/// its instances cover. Of surfaces equally far from the camera another may be hit. Frames whose
/// large triangles have more than `most_parts` (shared::DrawnPart) are traced as a whole.
DrawnHits<gpu::Declared> draw_camera_rays(gpu::FramePlan& plan, const FrameInputs& in,
                                          const tracing::WalkedHierarchy& hierarchy,
                                          const WalkedBuffers<gpu::Declared>& buffers,
                                          gpu::BufferRef traced, std::uint32_t most_parts);

/// Some layers of triangles that fill a frame of this size, and many small ones.
std::uint32_t most_drawn_parts(VkExtent2D extent);

/// Whether that is expected to be faster than tracing, and the device can do it.
bool draws_camera_rays(const gpu::FramePlan& plan, const FrameInputs& in,
                       const tracing::WalkedHierarchy& hierarchy);

}  // namespace heliograph::render
