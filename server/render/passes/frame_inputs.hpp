#pragma once

#include <cstdint>

#include "gpu/frame_plan/frame_plan.hpp"
#include "protocol/settings/settings.hpp"
#include "render/resources/programs.hpp"
#include "render/resources/scene_resources.hpp"
#include "shaders/shared/frame_constants.h"
#include "tracing/ray_tracer.hpp"

namespace heliograph::render {

class MovingScene;
struct SceneMotion;

/// What a frame is made from. References outlive the plan; `constants` changes from frame to frame.
struct FrameInputs {
  const Programs& programs;
  const SceneResources& scene;         // at rest
  const tracing::SceneTables& tables;  // what moves as it is now: bind these
  const tracing::RayTracer& tracer;
  const tracing::AccelerationStructure& structure;  // as it is now: trace this
  const shared::FrameConstants& constants;
  /// A setting that resets the structure may decide which passes are declared; every other one is
  /// read when a pass runs.
  const protocol::Settings& settings;
  const std::uint32_t& samples;       // already in the accumulated picture
  const float& seconds;               // since the frame before
  const MovingScene& moving;          // what the rasteriser draws
  const SceneMotion& scene_motion;    // since the frame before
  const gpu::Image& split_sum_table;  // rg32f, mapped on devices that are processors
  bool host_kernels = true;           // on devices that are processors, where a pass has one
};

/// Whether passes that have a host kernel run it.
inline bool on_host(const gpu::FramePlan& plan, const FrameInputs& in) {
  return in.host_kernels && plan.device().is_cpu();
}

/// The same for passes whose kernels know glTF's own material model alone.
inline bool shades_on_host(const gpu::FramePlan& plan, const FrameInputs& in) {
  return on_host(plan, in) && (in.scene.features & shared::scene_layers) == 0;
}

}  // namespace heliograph::render
