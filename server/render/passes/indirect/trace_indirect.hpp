#pragma once

#include <optional>

#include "render/passes/gbuffer/gbuffer.hpp"
#include "render/passes/indirect/radiance_cache.hpp"

namespace heliograph::render {

inline constexpr struct IndirectBuffers {
  BufferDescription radiance{"indirect.radiance", ViewColors::radiance,
                             "Indirect diffuse light that one ray per pixel gathers, without "
                             "albedo; negative (w) where no sample was taken."};
} indirect_buffers{};

/// One cosine-distributed ray per pixel, which takes the environment where it misses and what a
/// surface sends on of the light in the radiance cache where it hits.
/// @return rgba32f: irradiance / pi; w < 0 where no sample was taken
gpu::ImageRef trace_indirect(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                             const RadianceCache& cache, std::optional<gpu::ImageRef> planned);

}  // namespace heliograph::render
