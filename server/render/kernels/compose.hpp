#pragma once

#include <cstdint>
#include <span>

#include "render/kernels/common/frame_job.hpp"
#include "render/kernels/lights/reaching_lights.hpp"
#include "render/resources/host_tables.hpp"
#include "render/resources/lights/light_grid.hpp"

namespace heliograph::render::kernels {

/// shaders/compose/compose.comp, or compose_denoised.comp where there are denoised signals.
template <class Stage>
struct ComposeBindings {
  gpu::Read<Stage> normals, base_color, surface;
  gpu::Read<Stage> layers;  // shaders/lib/scene/layers.glsl, in scenes that have them
  gpu::Read<Stage> motion, emissive, background;
  gpu::Read<Stage> shadows, ambient, specular, indirect;  // noisy
  gpu::OptionalRead<Stage> denoised_visibility, denoised_specular, denoised_indirect;
  gpu::Write<Stage> hdr;
  gpu::OptionalWrite<Stage> hdr_noisy;
};
struct ComposeConstants {
  float max_roughness;           // below 0: no reflections were traced
  std::uint32_t has_background;  // 0, for shaders alone: looked up, there is no image of it
  std::uint32_t makes_noisy;     // 0: denoised radiance alone
};

struct ComposeJob : FrameJob<ComposeBindings, ComposeConstants> {
  bool layered;                   // materials of the scene have layers
  const ReachingLights& outside;  // of the lights' grid; the environment's sun among them
  SceneLights lights;
  LobeTables tables;
  const Environment& environment;
};

/// The frame from its signals on all processors, in the widest vectors that they have.
void compose(const ComposeJob& job);

}  // namespace heliograph::render::kernels
