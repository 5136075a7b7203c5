#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "shaders/shared/ray.h"
#include "tracing/embree/embree_scene.hpp"

namespace heliograph::tracing {

/// Rays per call of Embree; a multiple of its packet sizes.
inline constexpr std::size_t embree_batch = 1024;

/// A part of a ray stream. `blending`: seed of the stream. `coherent`: neighbouring rays have
/// nearly the same origin and direction, which changes speed only.
struct RayBatch {
  std::span<const shared::Ray> rays;  // at most `embree_batch`
  std::uint32_t blending = 0;
  bool coherent = false;
};

/// Writes the closest hit of every ray.
void intersect_batch(const EmbreeScenes& scenes, const RayBatch& batch, shared::Hit* hits);

/// Writes 1 for every ray with a hit, else 0.
void occluded_batch(const EmbreeScenes& scenes, const RayBatch& batch, std::uint32_t* occluded);

}  // namespace heliograph::tracing
