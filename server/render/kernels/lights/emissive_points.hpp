#pragma once

#include "render/kernels/common/frame_job.hpp"
#include "render/kernels/common/ray_sink.hpp"
#include "render/kernels/common/tile.hpp"
#include "render/resources/host_tables.hpp"
#include "shaders/shared/emissive.h"

/// Emissive triangles as lights, on all processors: shaders/lib/lighting/emissive_choice.glsl.
namespace heliograph::render::kernels {

/// shaders/lights/emissive_points.comp
template <class Stage>
struct EmissivePointsBindings {
  gpu::WriteBuffer<Stage, shared::EmissivePoint> points;
};
struct EmissivePointsJob : FrameJob<EmissivePointsBindings> {
  SceneView scene;
};
void emissive_points(const EmissivePointsJob& job);

/// shaders/lights/indirect_lights.comp
template <class Stage>
struct IndirectLightsBindings {
  gpu::Read<Stage> normals;   // rgba32f
  gpu::Read<Stage> motion;    // rgba32f
  gpu::Read<Stage> radiance;  // rgba32f; w < 0: no ray
  gpu::ReadBuffer<Stage, shared::EmissivePoint> points;
  RaySink<Stage> rays;
  gpu::Read<Stage> base_color, surface, layers;
};
struct IndirectLightsJob : FrameJob<IndirectLightsBindings> {
  bool both_sides;  // surfaces of the scene may scatter light to their other side
  LobeTables tables;
  Rows rows;  // whose rays are made
};
void indirect_lights(const IndirectLightsJob& job);

}  // namespace heliograph::render::kernels
