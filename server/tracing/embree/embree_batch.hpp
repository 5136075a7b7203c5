#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "shaders/shared/ray.h"
#include "tracing/embree/embree.hpp"

namespace heliograph::tracing {

/// Rays per call of Embree; a multiple of its packet sizes.
inline constexpr std::size_t embree_batch = 256;

/// Closest hits of at most `embree_batch` rays in a scene of instances. `blending`: seed of their
/// stream.
void intersect_batch(RTCScene scene, std::span<const shared::Ray> rays, std::uint32_t blending,
                     shared::Hit* hits);

/// 1 for every ray with a hit, else 0.
void occluded_batch(RTCScene scene, std::span<const shared::Ray> rays, std::uint32_t blending,
                    std::uint32_t* occluded);

}  // namespace heliograph::tracing
