#pragma once

#include "gpu/frame_plan/bindings.hpp"
#include "render/kernels/indirect/cell_level.hpp"
#include "shaders/shared/path_guide.h"
#include "shaders/shared/radiance_cache.h"

/// Where light has come from, learnt for places of the world: shaders/lib/lighting/path_guide.glsl.
namespace heliograph::render::kernels {

/// Two numbers that a direction is made of.
struct GuidedPair {
  glm::vec2 u;  // in [0, 1)
  std::uint32_t bin;
  float weight;  // density without a guide over that with it
};

GuidedPair unguided_pair(const glm::vec2& u);

/// The numbers that take the place of `u` at `position`: those of unguided_pair() where the guide
/// knows nothing. `normal`: geometric, on the side that light comes from.
GuidedPair guided_pair(const shared::GuideEntry* guide, const CellScale& scale,
                       const glm::vec3& position, const glm::vec3& normal, const glm::vec2& u);

/// Adds what the gathering ray of a cell has brought.
void learn(shared::GuideEntry* guide, const CellScale& scale, const shared::RadianceCell& cell,
           std::uint32_t frame_number);

/// shaders/indirect/path_guide.comp
template <class Stage>
struct PathGuideBindings {
  gpu::ReadWriteBuffer<Stage, shared::GuideEntry> guide;
};
using PathGuideJob = gpu::HostPass<PathGuideBindings, shared::RadianceCacheConstants>;
void path_guide(const PathGuideJob& job);

}  // namespace heliograph::render::kernels
