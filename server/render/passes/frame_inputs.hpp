#pragma once

#include <cstdint>
#include <optional>

#include "gpu/frame_plan/frame_plan.hpp"
#include "protocol/settings/settings.hpp"
#include "render/kernels/common/frame_job.hpp"
#include "render/resources/programs.hpp"
#include "render/resources/scene_resources.hpp"
#include "shaders/shared/frame_constants.h"
#include "tracing/ray_tracer.hpp"

namespace heliograph::render {

class MovingScene;
struct SceneMotion;

/// Where a frame stands in time.
struct FrameClock {
  std::uint32_t samples = 0;     // already in the accumulated mean
  std::uint32_t age = 0;         // frames since the history was invalid
  float seconds = 1.0f / 60.0f;  // since the frame before
  /// Whether the first of these samples is part of the mean: it is not if it left pixels out.
  bool first_counts = true;
  /// How many samples a static view's histories brought along, as a part of what they count: less
  /// than 1 where they come from frames that were drawn smaller.
  float carried_share = 1.0f;
  /// Samples of the hybrid before the reference took over in a static view; absent: it has not.
  std::optional<std::uint32_t> hybrid_samples;

  /// Whether so few frames have passed that all light is still uncertain.
  static constexpr std::uint32_t young_frames = 24;
  bool is_young() const { return age < young_frames; }
};

inline bool denoises_visibility(const protocol::Settings& s) {
  return s.shadow_temporal.enabled || s.shadow_blur.enabled;
}
inline bool denoises_specular(const protocol::Settings& s) {
  return s.specular.enabled && (s.specular_temporal.enabled || s.specular_blur.enabled);
}
inline bool denoises_indirect(const protocol::Settings& s) {
  return s.indirect.enabled && (s.indirect_temporal.enabled || s.indirect_blur.enabled);
}

inline glm::uvec2 size_of(VkExtent2D extent) {
  return {extent.width, extent.height};
}

/// What a frame is made from. References outlive the plan; `constants`, `clock` and `all_buffers`
/// may change in every frame.
struct FrameInputs {
  const Programs& programs;
  const SceneResources& scene;         // in its default pose
  const tracing::SceneTables& tables;  // in the pose of this frame: bind these
  const tracing::RayTracer& tracer;
  const tracing::AccelerationStructure& structure;  // in the pose of this frame: trace this
  const shared::FrameConstants& constants;
  const shared::FrameConstants& half_constants;  // of this frame at half the size
  /// A setting that resets the structure may decide which passes are declared; every other one is
  /// read when a pass runs.
  const protocol::Settings& settings;
  const FrameClock& clock;
  const MovingScene& moving;        // what the rasteriser draws
  const SceneMotion& scene_motion;  // since the frame before
  const bool& all_buffers;          // whether what this frame does not show can be read, too
  // Mapped on devices that are processors.
  const gpu::Image& split_sum_table;  // rg32f
  const gpu::Image& sheen_table;      // r32f
  const gpu::Image& ltc_table;        // rgba32f
  VkExtent2D shown;                   // size of the finished frame, pixels

  /// For passes that the plan reduces by 2.
  FrameInputs at_half_size() const {
    return {programs,        scene,       tables,    tracer, structure,    half_constants,
            half_constants,  settings,    clock,     moving, scene_motion, all_buffers,
            split_sum_table, sheen_table, ltc_table, shown};
  }

  /// Whether this frame is drawn smaller than it is shown.
  bool is_reduced() const { return constants.extent != size_of(shown); }

  /// The compute program of an embedded shader, made for a scene with these features (all of them
  /// where the shader does not ask) when the plan needs it.
  gpu::ProgramSource program(const gpu::ShaderBinary& shader, std::uint32_t features = ~0u) const {
    return [&all = programs, &shader, features,
            unbound = scene.for_kernels_only]() -> const gpu::ComputeProgram& {
      const gpu::ComputeProgram& program = all.compute(shader, features);
      if (unbound && program.uses_set(scene_set)) {
        throw gpu::GpuError(
            "these settings need a shader that reads the scene, which is larger "
            "than what this device binds");
      }
      return program;
    };
  }

  kernels::LobeTables lobe_tables() const {
    const auto texels = [](const gpu::Image& table) {
      return kernels::SquareTexels{table.host(), static_cast<int>(table.desc().extent.width)};
    };
    return {texels(split_sum_table), texels(sheen_table), texels(ltc_table)};
  }
};

}  // namespace heliograph::render
