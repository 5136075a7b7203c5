#pragma once

#include <cstddef>
#include <string>

#include "render/kernels/ray_sink.hpp"
#include "render/passes/frame_inputs.hpp"
#include "shaders/shared/ray.h"

namespace heliograph::render {

/// Where a stream's RayCount keeps the arguments of an indirect dispatch, one thread per ray.
inline constexpr VkDeviceSize ray_groups_offset = offsetof(shared::RayCount, groups_x);

/// The buffers of a stream: `name`.ray_count and `name`.rays.
tracing::RayStream declare_rays(gpu::FramePlan& plan, const std::string& name,
                                std::uint32_t capacity);

/// How a stream's rays meet blended surfaces: stopped by all of them, or by their share.
enum class Blending { stops, shares };

/// RayCount::blending of a frame's streams; the same in shaders/lib/denoise/frame_blending.glsl.
std::uint32_t frame_blending(const FrameInputs& in);

/// The pass `name`.begin, which empties the stream.
void begin_rays(gpu::FramePlan& plan, const FrameInputs& in, const std::string& name,
                const tracing::RayStream& rays, Blending blending = Blending::shares);

/// Whether passes that have a kernel run it.
inline bool by_host(const gpu::FramePlan& plan, const FrameInputs& in) {
  return in.host_kernels && plan.device().is_cpu();
}

/// A buffer as kernels on the host see it.
template <typename Element>
Element* mapped(const gpu::FramePlan& plan, gpu::BufferRef buffer) {
  return reinterpret_cast<Element*>(plan.get(buffer).mapped());
}
inline kernels::RaySource ray_source(const gpu::FramePlan& plan, const tracing::RayStream& rays) {
  return {mapped<const shared::RayCount>(plan, rays.count),
          mapped<const shared::Ray>(plan, rays.rays)};
}
/// For one frame.
inline kernels::RaySink ray_sink(const gpu::FramePlan& plan, const FrameInputs& in,
                                 const tracing::RayStream& rays,
                                 Blending blending = Blending::shares) {
  return {mapped<shared::RayCount>(plan, rays.count), mapped<shared::Ray>(plan, rays.rays),
          blending == Blending::shares ? frame_blending(in) : 0u};
}

}  // namespace heliograph::render
