#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "shaders/shared/ray.h"
#include "tracing/embree/embree.hpp"

namespace heliograph::tracing {

/// Rays that one call hands to Embree together; a multiple of its packets.
inline constexpr std::size_t embree_batch = 256;

/// Closest hits of at most `embree_batch` rays in a scene of instances. `blending`: of their
/// stream.
void intersect_batch(RTCScene scene, std::span<const shared::Ray> rays, std::uint32_t blending,
                     shared::Hit* hits);

/// 1 for every ray that hits anything, else 0.
void occluded_batch(RTCScene scene, std::span<const shared::Ray> rays, std::uint32_t blending,
                    std::uint32_t* occluded);

}  // namespace heliograph::tracing
