#pragma once

#include <functional>
#include <optional>
#include <string>

#include "protocol/settings/settings.hpp"
#include "render/kernels/atrous.hpp"
#include "render/passes/denoise/reproject.hpp"
#include "shaders/shared/denoise.h"

namespace heliograph::render {

struct KernelShape;

inline constexpr std::array visibility_denoised_aspects{
    Aspect{"noise", ViewColors::deviation, 2, second_pair,
           "Standard deviation that the blur leaves, of shadow or ambient visibility, the "
           "larger; captured: both variances."}};
inline constexpr std::array specular_denoised_aspects{
    Aspect{"noise", ViewColors::deviation, 1, one_channel<3>,
           "Standard deviation of the reflection's brightness that the blur leaves; captured: "
           "variance."}};

/// Between the passes of a separable blur by shaders 16 bits a channel, with standard deviations in
/// place of variances; otherwise, and what is denoised, 32 bits. What blur_together() has denoised
/// holds 16 bits, with variances.
struct AtrousBuffers {
  BufferDescription even, odd;  // between iterations
  BufferDescription half;       // between the halves of a separable iteration, in shaders
  BufferDescription denoised;
};
inline constexpr AtrousBuffers visibility_atrous_buffers{
    {"visibility.blur.even", ViewColors::channels, "Visibility after an iteration of the blur."},
    {"visibility.blur.odd", ViewColors::channels, "Visibility after an iteration of the blur."},
    {"visibility.blur.half", ViewColors::channels,
     "Visibility after the first half of a separable iteration of the blur."},
    {.name = "visibility.denoised",
     .colors = ViewColors::channels,
     .description = "Denoised shadow (red) and ambient (green) visibility; variances (zw).",
     .aspects = visibility_denoised_aspects}};
inline constexpr AtrousBuffers visibility_half_atrous_buffers{
    {"visibility.half.blur.even", ViewColors::channels,
     "Visibility at half the size after an iteration of the blur."},
    {"visibility.half.blur.odd", ViewColors::channels,
     "Visibility at half the size after an iteration of the blur."},
    {"visibility.half.blur.half", ViewColors::channels,
     "Visibility at half the size after the first half of a separable iteration of the blur."},
    {"visibility.half.denoised", ViewColors::channels,
     "Denoised shadow (red) and ambient (green) visibility at half the size; variances (zw)."}};
inline constexpr AtrousBuffers specular_atrous_buffers{
    {"specular.blur.even", ViewColors::radiance, "Reflections after an iteration of the blur."},
    {"specular.blur.odd", ViewColors::radiance, "Reflections after an iteration of the blur."},
    {"specular.blur.half", ViewColors::radiance,
     "Reflections after the first half of a separable iteration of the blur."},
    {.name = "specular.denoised",
     .colors = ViewColors::radiance,
     .description = "Denoised reflections, demodulated; variance of their brightness (w).",
     .aspects = specular_denoised_aspects}};
inline constexpr std::array indirect_denoised_aspects{
    Aspect{"noise", ViewColors::deviation, 1, one_channel<3>,
           "Standard deviation of the indirect light's brightness that the blur leaves; captured: "
           "variance."}};
inline constexpr AtrousBuffers indirect_atrous_buffers{
    {"indirect.blur.even", ViewColors::radiance,
     "Indirect diffuse light after an iteration of the blur."},
    {"indirect.blur.odd", ViewColors::radiance,
     "Indirect diffuse light after an iteration of the blur."},
    {"indirect.blur.half", ViewColors::radiance,
     "Indirect diffuse light after the first half of a separable iteration of the blur."},
    {.name = "indirect.denoised",
     .colors = ViewColors::radiance,
     .description =
         "Denoised indirect diffuse light, without albedo; variance of its brightness (w).",
     .aspects = indirect_denoised_aspects}};

/// Images of one size: what is blurred and what guides it.
struct AtrousInput {
  gpu::ImageRef guide;        // shaders/lib/denoise/guide.glsl
  gpu::ImageRef depth_slope;  // from texel to texel
  gpu::ImageRef signal;
  PackedGuide packed;
};

/// Shaders of the halves of separable iterations, by what they read and write: the signal to be
/// blurred, what lies between passes, the result.
struct AtrousHalfPrograms {
  gpu::ProgramSource first;  // from the signal
  gpu::ProgramSource between;
  gpu::ProgramSource last;  // to the result
  gpu::ProgramSource last_in_halves;
};

/// A blur of one signal: how often, and what its passes read every frame.
struct AtrousConfig {
  std::string name;  // of the passes, before the number of the iteration
  const AtrousBuffers& buffers;
  gpu::ProgramSource program;
  AtrousHalfPrograms half_programs;
  void (*kernel)(const kernels::AtrousJob&);
  void (*halves_kernel)(const kernels::AtrousHalvesJob&);
  int iterations;
  protocol::BlurKernel shape;
  std::function<shared::AtrousConstants(const KernelShape&)> constants;
  std::uint32_t pixels_per_texel = 1;  // of the images, along each axis
};

/// A blur without feedback.
struct SignalBlur {
  AtrousInput input;
  AtrousConfig config;
};

/// A blur of radiance with the variance of its brightness.
AtrousConfig radiance_atrous_config(
    const FrameInputs& in, std::string name, const AtrousBuffers& buffers, int iterations,
    protocol::BlurKernel shape,
    std::function<shared::AtrousConstants(const KernelShape&)> constants);

/// Gets the result of iteration `level`, for the next frame.
struct Feedback {
  int level;
  std::function<void(gpu::ImageRef)> keep;
};

/// The a-trous filter (Dammertz et al. 2010; paper sections 3.2 and 3.3): `iterations` passes, or
/// twice as many halves, whose distance between taps doubles from one to the next. A host kernel
/// runs both halves in one pass.
/// @return the last iteration's result
gpu::ImageRef blur(gpu::FramePlan& plan, const FrameInputs& in, const AtrousInput& input,
                   const AtrousConfig& config, std::optional<Feedback> feedback);

/// Whether blur_together() knows the case: halves by shaders on a GPU, where nothing is fed back.
bool can_blur_together(const gpu::FramePlan& plan, const protocol::BlurSettings& a,
                       const protocol::BlurSettings& b);

struct BlurredPair {
  gpu::ImageRef visibility, specular;
};
/// Blurs of both signals at full size, with the same guide: by passes for both, which weigh
/// surfaces once, in frames where both sample the same texels; otherwise as blur() does. Visibility
/// is blurred in frames where `traces_visibility` is true.
BlurredPair blur_together(gpu::FramePlan& plan, const FrameInputs& in, const SignalBlur& visibility,
                          const SignalBlur& specular,
                          const std::function<bool()>& traces_visibility);

}  // namespace heliograph::render
