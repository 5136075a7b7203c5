#include "render/passes/post/exposure.hpp"

#include <cmath>
#include <cstring>

#include "render/kernels/post/exposure.hpp"
#include "render/passes/frame_inputs.hpp"
#include "render/passes/post/mean_weight.hpp"
#include "render/resources/environment/background.hpp"
#include "render/resources/moving/moving_scene.hpp"
#include "shaders/embedded.hpp"
#include "shaders/shared/exposure.h"

namespace heliograph::render {
namespace {

/// How many stops automatic exposure may be away from manual exposure; 0: it is manual.
float automatic_reach(const FrameInputs& in) {
  constexpr float unlimited = 64.0f, of_studio = 1.0f;
  switch (in.settings.exposure.mode) {
    case protocol::ExposureMode::manual:
      return 0.0f;
    case protocol::ExposureMode::automatic:
      return unlimited;
    case protocol::ExposureMode::by_scene:
      break;
  }
  // A background that was chosen for its colour keeps it.
  const bool by_studio =
      shows_environment(in.settings.background) && in.moving.lit_by_studio_alone();
  return by_studio ? of_studio : 0.0f;
}

/// Fills the histogram.
void meter(gpu::FramePlan& plan, const FrameInputs& in, gpu::ImageRef hdr, gpu::ImageRef mean,
           gpu::BufferRef histogram) {
  plan.pass("exposure.begin", in.program(shaders::exposure_begin))
      .bind<kernels::ExposureBeginBindings>({.histogram = histogram})
      .dispatch({shared::exposure_bins, 1})
      .host(kernels::exposure_begin);
  plan.pass("exposure.meter", in.program(shaders::exposure_meter))
      .bind<kernels::ExposureMeterBindings>({.hdr = hdr, .mean = mean, .histogram = histogram})
      .constants([in] { return kernels::ExposureMeterConstants{mean_share(in)}; })
      .dispatch(gpu::FrameSize::squares(2))
      .host(kernels::exposure_meter);
}

shared::ExposureState read_state(const gpu::FramePlan& plan, const Exposure& exposure) {
  shared::ExposureState state;
  std::memcpy(&state, plan.get(exposure.report).mapped(), sizeof state);
  return state;
}

}  // namespace

Exposure expose(gpu::FramePlan& plan, const FrameInputs& in, gpu::ImageRef hdr,
                gpu::ImageRef mean) {
  constexpr VkBufferUsageFlags storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  constexpr VkDeviceSize size = sizeof(shared::ExposureState);
  const Exposure exposure{
      plan.buffer("exposure", size, storage | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT,
                  gpu::Memory::device),
      plan.buffer("exposure.report", size, storage, gpu::Memory::readback)};
  const auto histogram =
      plan.buffer("exposure.histogram", shared::exposure_bins * sizeof(std::uint32_t), storage,
                  gpu::Memory::device);
  const float reach = automatic_reach(in);
  const bool automatic = reach > 0.0f;
  if (automatic) meter(plan, in, hdr, mean, histogram);
  plan.pass("exposure.adapt", in.program(shaders::exposure_adapt))
      .bind<kernels::ExposureAdaptBindings>(
          {.histogram = histogram, .state = exposure.state, .report = exposure.report})
      .constants([&clock = in.clock, &settings = in.settings, reach] {
        const bool adapts = settings.exposure.mode == protocol::ExposureMode::automatic ||
                            settings.environment.visible;
        return kernels::ExposureAdaptConstants{clock.seconds, settings.exposure.adaptation,
                                               adapts ? reach : 0.0f};
      })
      .dispatch({1, 1})
      .host(kernels::exposure_adapt, in.constants);
  return exposure;
}

bool is_settled(const gpu::FramePlan& plan, const Exposure& exposure) {
  const shared::ExposureState state = read_state(plan, exposure);
  return std::abs(state.target - state.stops) < 0.01f;
}

float exposure_factor(const gpu::FramePlan& plan, const Exposure& exposure) {
  return read_state(plan, exposure).factor;
}

}  // namespace heliograph::render
