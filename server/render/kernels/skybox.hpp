#pragma once

#include "render/kernels/common/frame_job.hpp"
#include "render/resources/host_tables.hpp"

namespace heliograph::render::kernels {

/// shaders/compose/skybox.comp
template <class Stage>
struct SkyboxBindings {
  gpu::Read<Stage> motion;       // rgba32f
  gpu::Write<Stage> background;  // rgba32f
};
struct SkyboxJob : FrameJob<SkyboxBindings> {
  RadianceMap map;  // what the eye sees behind the scene
};

/// The background where there is no surface, on all processors; elsewhere black, at the cost of
/// filling the image.
void skybox(const SkyboxJob& job);

}  // namespace heliograph::render::kernels
