#include "render/passes/post/exposure.hpp"

#include <cmath>
#include <cstring>

#include "render/kernels/post/exposure.hpp"
#include "render/passes/frame_inputs.hpp"
#include "render/passes/post/mean_weight.hpp"
#include "shaders/embedded.hpp"
#include "shaders/shared/exposure.h"

namespace heliograph::render {
namespace {

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
  const bool automatic = in.settings.exposure.mode == protocol::ExposureMode::automatic;
  if (automatic) meter(plan, in, hdr, mean, histogram);
  plan.pass("exposure.adapt", in.program(shaders::exposure_adapt))
      .bind<kernels::ExposureAdaptBindings>(
          {.histogram = histogram, .state = exposure.state, .report = exposure.report})
      .constants([&clock = in.clock, &settings = in.settings.exposure, automatic] {
        return kernels::ExposureAdaptConstants{clock.seconds, settings.adaptation, automatic};
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
