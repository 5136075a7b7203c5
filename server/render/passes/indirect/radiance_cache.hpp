#pragma once

#include "render/api/frame_values.hpp"
#include "render/passes/frame_inputs.hpp"
#include "render/resources/host_tables.hpp"
#include "shaders/shared/radiance_cache.h"

namespace heliograph::render {

/// Light at places of the world: shaders/shared/radiance_cache.h. Stays from frame to frame.
struct RadianceCache {
  gpu::BufferRef keys;    // uint
  gpu::BufferRef cells;   // shared::RadianceCell
  gpu::BufferRef points;  // draw_emissive_points(), of this frame
  gpu::BufferRef guide;   // shared::GuideEntry
  gpu::BufferRef report;  // uint: how many cells there are, for the host
};

/// Memory of one cache, and how many of its cells a frame that has run has left alive.
CacheUse radiance_cache_use(const gpu::FramePlan& plan, const RadianceCache& cache);

shared::RadianceCacheConstants cache_constants(const FrameInputs& in);

/// The environment that lights this frame, for host kernels.
const kernels::Environment& host_environment(const FrameInputs& in);

/// Updates some of the cells that earlier frames have asked for: one light with a shadow ray, and
/// one ray that gathers what other cells know.
RadianceCache update_radiance_cache(gpu::FramePlan& plan, const FrameInputs& in);

}  // namespace heliograph::render
