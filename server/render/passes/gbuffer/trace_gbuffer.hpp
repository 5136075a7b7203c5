#pragma once

#include "gpu/device/device_choice.hpp"
#include "protocol/messages/kinds.hpp"
#include "render/kernels/common/tile.hpp"
#include "render/passes/gbuffer/gbuffer.hpp"
#include "tracing/ray_tracer.hpp"

namespace heliograph::render {

/// The same G-buffer as rasterize_gbuffer, found by rays through the pixels: its cost follows the
/// pixels, not the triangles. Depth slopes are those of the surface's plane, texture detail that of
/// a ray cone (Akenine-Möller et al. 2021). Behind three surfaces that let a ray pass, the fourth
/// is taken as it is; in scenes with blended surfaces the eighth. `depth` stays empty. In rounds of
/// passes, or as walk_gbuffer does.
GBuffer trace_gbuffer(gpu::FramePlan& plan, const FrameInputs& in);

/// The pass `name` that fills a stream with a ray through the sample of every pixel of these rows,
/// tiles of 8 x 8 one after the other; what sticks out of the frame has empty intervals. Devices
/// without host kernels: all rows.
void camera_rays(gpu::FramePlan& plan, const FrameInputs& in, const std::string& name,
                 const tracing::RayStream& rays, kernels::Rows rows);

/// How many there are.
std::uint32_t camera_ray_capacity(std::uint32_t width, kernels::Rows rows);

/// How many surfaces behind each other are tried: the last is taken as it is.
std::uint32_t camera_rounds(const FrameInputs& in);

/// Whether rays find the G-buffer sooner than drawing does.
/// Processors: Embree takes no longer than the rasteriser for the simplest of scenes, and a third
/// of its time with hundreds of thousands of triangles; the other tracers are slower.
/// GPUs: those of data centres have no units for rays, which shows in a driver that traces by
/// pipelines and offers no queries. What they have is arithmetic: our own hierarchy in a compute
/// shader made the G-buffer in half of the rasteriser's time on an H100 (5.6 against 9.9 ms).
/// Others draw: that is what their raster units are for.
bool rays_find_gbuffer_sooner(const gpu::DeviceReport& device, protocol::TracerKind tracer);

/// Whether rays find the G-buffer on this device with these settings.
bool traces_gbuffer(const gpu::Device& device, const FrameInputs& in);

}  // namespace heliograph::render
