#pragma once

#include "render/passes/frame_inputs.hpp"
#include "tracing/ray_tracer.hpp"

namespace heliograph::render {

/// Adds the passes that write shared::Hit for the camera rays of all pixels, like `gbuffer.trace`,
/// without tracing what does not move: triangles of the hierarchy's flat tree are drawn by
/// compute shaders, each intersected with the rays of the pixels that it covers, and the nearest
/// stays (Laine and Karras, HPG 2011; small ones by an invocation each, as Karis et al., SIGGRAPH
/// 2021). Backs of one-sided triangles, which camera rays go on through, are left out where no
/// mirror turns them, and so are holes that the filtered texels of masks have. Only the rest of the
/// scene is traced. Of surfaces equally far from the camera another may be hit. Frames whose large
/// triangles have more than `most_parts` (shared::DrawnPart) are traced as a whole.
void draw_camera_rays(gpu::FramePlan& plan, const FrameInputs& in,
                      const tracing::WalkedHierarchy& hierarchy, gpu::BufferRef hits,
                      std::uint32_t most_parts);

/// Some layers of triangles that fill a frame of this size, and many small ones.
std::uint32_t most_drawn_parts(VkExtent2D extent);

/// Whether that is expected to be faster than tracing, and the device can do it.
bool draws_camera_rays(const gpu::FramePlan& plan, const FrameInputs& in,
                       const tracing::WalkedHierarchy& hierarchy);

}  // namespace heliograph::render
