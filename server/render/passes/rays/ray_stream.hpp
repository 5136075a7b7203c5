#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "render/kernels/common/ray_sink.hpp"
#include "render/kernels/common/tile.hpp"
#include "render/passes/frame_inputs.hpp"
#include "shaders/shared/ray.h"

namespace heliograph::render {

/// Where a stream's RayCount keeps the arguments of an indirect dispatch, one thread per ray.
inline constexpr VkDeviceSize ray_groups_offset = offsetof(shared::RayCount, groups_x);

/// The buffers of a stream: `name`.ray_count and `name`.rays.
tracing::RayStream declare_rays(gpu::FramePlan& plan, const std::string& name,
                                std::uint32_t capacity, tracing::RayKind kind);

/// How a stream's rays meet blended surfaces: all of them stop rays, or each its coverage's
/// fraction.
enum class Blending { stops, by_coverage };

/// The pass `name`.begin, which empties the stream.
void begin_rays(gpu::FramePlan& plan, const FrameInputs& in, const std::string& name,
                const tracing::RayStream& rays, Blending blending = Blending::by_coverage);

/// Whether earlier passes have left any rays, where host kernels do: then none cost nothing.
/// Elsewhere the device knows and the host does not: true. `plan` outlives it.
std::function<bool()> has_rays(const gpu::FramePlan& plan, const tracing::RayStream& rays);

/// The rows of a frame of that size, in parts whose rays are made, traced and resolved before those
/// of the next: where the host does so, the buffers of one part are enough for all. Elsewhere one.
std::vector<kernels::Rows> ray_strips(const gpu::FramePlan& plan, VkExtent2D extent);

/// A stream in the list of a pass's bindings.
inline kernels::RaySource<gpu::Declared> ray_source(const tracing::RayStream& rays) {
  return {rays.count, rays.rays};
}
inline kernels::RaySink<gpu::Declared> ray_sink(const tracing::RayStream& rays) {
  return {rays.count, rays.rays};
}

}  // namespace heliograph::render
