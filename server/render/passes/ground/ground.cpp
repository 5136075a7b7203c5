#include "render/passes/ground/ground.hpp"

#include <algorithm>
#include <cstring>
#include <functional>
#include <utility>
#include <vector>

#include "render/kernels/ground/ground.hpp"
#include "render/passes/formats.hpp"
#include "render/passes/rays/ray_stream.hpp"
#include "render/resources/ground_plane.hpp"
#include "render/resources/moving/moving_scene.hpp"
#include "render/resources/moving/scene_motion.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {
namespace {

using formats::storage;

constexpr std::uint32_t ground_texels = shared::ground_side * shared::ground_side;
constexpr std::uint32_t frames_of_rays = 64;
// While things move and shortly after, frames count less and less.
constexpr std::uint32_t moving_frames = 8;
constexpr float kept_in_motion = 0.6f;

/// Frames since what is known was new.
std::uint32_t frames_of_ground(const FrameInputs& in) {
  return std::min(in.clock.age, in.scene_motion.still_frames);
}

float kept_of_ground(const FrameInputs& in) {
  if (in.constants.history_invalid != 0) return 0.0f;
  return in.scene_motion.still_frames < moving_frames ? kept_in_motion : 1.0f;
}

/// In which a texel and those around it have some 200 samples.
int ground_filter_radius(std::uint32_t frames) {
  return frames < 4 ? 3 : frames < 12 ? 2 : frames < 32 ? 1 : 0;
}

/// The frame before may be on the device, which reads the same lights: nothing but the camera has
/// changed since. Then they are not written again.
std::function<void()> write_ground_lights(gpu::FramePlan& plan, const FrameInputs& in,
                                          gpu::BufferRef lights) {
  using Lights = std::vector<shared::GroundLight>;
  return [&plan, in, lights, written = Lights()]() mutable {
    Lights chosen(shared::ground_lights);
    const bool separate_sun = in.settings.environment.separate_sun;
    choose_ground_lights(in.constants, *in.moving.environment().upper_light(separate_sun),
                         in.moving.lights(), chosen);
    const std::size_t bytes = chosen.size() * sizeof(shared::GroundLight);
    if (!written.empty() && std::memcmp(written.data(), chosen.data(), bytes) == 0) return;
    std::memcpy(plan.get(lights).mapped(), chosen.data(), bytes);
    written = std::move(chosen);
  };
}

}  // namespace

gpu::BufferRef trace_ground(gpu::FramePlan& plan, const FrameInputs& in) {
  const bool catches = catches_shadows(in.settings, in.moving);
  const gpu::BufferRef shade = plan.buffer(
      "ground.shade", sizeof(float) * (catches ? ground_texels : 1), storage, gpu::Memory::device);
  if (!catches) return shade;
  plan.only_when(
      [in] { return frames_of_ground(in) < frames_of_rays; },
      [&] {
        const auto lights =
            plan.buffer("ground.lights", sizeof(shared::GroundLight) * shared::ground_lights,
                        storage, gpu::Memory::upload);
        plan.host("ground.lights", write_ground_lights(plan, in, lights));
        const tracing::RayStream rays = declare_rays(
            plan, "ground", ground_texels * shared::ground_rays, tracing::RayKind::ambient);
        begin_rays(plan, in, "ground", rays);
        plan.pass("ground.rays", in.program(shaders::ground_rays))
            .bind<kernels::GroundRaysBindings>({.lights = lights, .rays = ray_sink(rays)})
            .dispatch({ground_texels, 1})
            .host(kernels::ground_rays, in.constants);
        const auto occluded = plan.buffer("ground.occluded", sizeof(std::uint32_t) * rays.capacity,
                                          storage, gpu::Memory::device);
        in.tracer.trace_any(plan, "ground.trace", in.structure, rays, occluded);
        const auto known = plan.buffer("ground.texels", sizeof(shared::GroundTexel) * ground_texels,
                                       storage, gpu::Memory::device);
        plan.pass("ground.gather", in.program(shaders::ground_gather))
            .bind<kernels::GroundGatherBindings>(
                {.rays = rays.rays, .occluded = occluded, .texels = known})
            .constants([in] { return kernels::GroundGatherConstants{kept_of_ground(in)}; })
            .dispatch({ground_texels, 1})
            .host(kernels::ground_gather);
        plan.pass("ground.filter", in.program(shaders::ground_filter))
            .bind<kernels::GroundFilterBindings>({.texels = known, .shade = shade})
            .constants([in] {
              return kernels::GroundFilterConstants{ground_filter_radius(frames_of_ground(in))};
            })
            .dispatch({shared::ground_side, shared::ground_side})
            .host(kernels::ground_filter);
      });
  return shade;
}

void shade_ground(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                  gpu::BufferRef ground, gpu::ImageRef background) {
  if (!catches_shadows(in.settings, in.moving)) return;
  plan.pass("ground.shade", in.program(shaders::ground_shade))
      .bind<kernels::GroundShadeBindings>(
          {.motion = gbuffer.motion, .shade = ground, .background = background})
      .dispatch(gpu::each_pixel())
      .host(kernels::ground_shade, in.constants);
}

}  // namespace heliograph::render
