#pragma once

#include "render/kernels/common/frame_job.hpp"
#include "render/kernels/common/ray_sink.hpp"
#include "render/kernels/common/tile.hpp"
#include "render/resources/lights/light_grid.hpp"

namespace heliograph::render::kernels {

/// shaders/visibility/shadows_rays.comp. The rays are those of the shader in another order.
template <class Stage>
struct ShadowRaysBindings {
  gpu::Read<Stage> normals, motion, base_color, surface, layers;
  RaySink<Stage> rays;
  gpu::Read<Stage> planned;  // r32ui, shaders/shared/sampling.h, or anything
  /// r32f: 1 where the ray decides, 0 where there is none to trace, -1 where the plan leaves it out
  gpu::Write<Stage> visibility;
};
struct VisibilityRaysConstants {
  std::uint32_t by_plan;  // 0: every pixel is sampled
};
struct ShadowRaysJob : FrameJob<ShadowRaysBindings, VisibilityRaysConstants> {
  bool layered;        // materials of the scene have layers
  SceneLights lights;  // the environment's sun among them
  LobeTables tables;
  Rows rows;  // whose rays are made
};

/// One ray per pixel toward one light, on all processors, in the widest vectors that they have.
void shadows_rays(const ShadowRaysJob& job);

/// shaders/visibility/ambient_rays.comp
template <class Stage>
struct AmbientRaysBindings {
  gpu::Read<Stage> normals, motion;
  RaySink<Stage> rays;
  gpu::Read<Stage> planned;      // as above
  gpu::Write<Stage> visibility;  // as above
};
struct AmbientRaysJob : FrameJob<AmbientRaysBindings, VisibilityRaysConstants> {
  Rows rows;  // as above
};

/// One ray per pixel over the hemisphere.
void ambient_rays(const AmbientRaysJob& job);

}  // namespace heliograph::render::kernels
