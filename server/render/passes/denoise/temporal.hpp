#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>

#include "protocol/settings/settings.hpp"
#include "render/passes/denoise/reproject.hpp"

namespace heliograph::render {

inline constexpr std::array visibility_history_length_aspects{
    Aspect{"rectified", ViewColors::heat, 2, second_pair,
           "How far rectification moved the visibility history: shadow, ambient."}};
inline constexpr std::array visibility_temporal_aspects{
    Aspect{"noise", ViewColors::deviation, 2, second_pair,
           "Standard deviation before the blur, of shadow or ambient visibility, the larger; "
           "captured: both variances."}};
inline constexpr std::array specular_history_length_aspects{
    Aspect{"rectified", ViewColors::heat, 1, one_channel<1>,
           "How far rectification moved the reflection's history."}};
inline constexpr std::array specular_temporal_aspects{
    Aspect{"noise", ViewColors::deviation, 1, one_channel<3>,
           "Standard deviation of the reflection's brightness before the blur; captured: "
           "variance."}};

inline constexpr struct VisibilityTemporalBuffers {
  BufferDescription percentiles{
      "visibility.percentiles", ViewColors::channels,
      "Tenth and ninetieth percentile of shadow and ambient visibility in every tile of 8x8 "
      "pixels."};
  BufferDescription history{"visibility.history", ViewColors::channels,
                            "Accumulated shadow (red) and ambient (green) visibility, which the "
                            "next frame goes on from; variances (zw)."};
  BufferDescription moments{"visibility.moments", ViewColors::channels,
                            "First and second moments of single samples: shadow (xz), ambient "
                            "(yw)."};
  BufferDescription history_length{
      .name = "visibility.history_length",
      .colors = ViewColors::heat,
      .description = "Frames in the history: shadow, ambient; how far rectification moved it (zw).",
      .aspects = visibility_history_length_aspects};
  BufferDescription fast_history{"visibility.fast_history", ViewColors::channels,
                                 "Shadow (red) and ambient (green) visibility of the last few "
                                 "frames alone."};
  BufferDescription signal{
      .name = "visibility.temporal",
      .colors = ViewColors::channels,
      .description = "Accumulated shadow (red) and ambient (green) visibility; variances (zw).",
      .aspects = visibility_temporal_aspects};
} visibility_temporal_buffers{};

inline constexpr std::array indirect_history_length_aspects{
    Aspect{"rectified", ViewColors::heat, 1, one_channel<1>,
           "How far rectification moved the indirect light's history."}};
inline constexpr std::array indirect_temporal_aspects{
    Aspect{"noise", ViewColors::deviation, 1, one_channel<3>,
           "Standard deviation of the indirect light's brightness before the blur; captured: "
           "variance."}};

/// Of a channel that carries radiance.
struct RadianceTemporalBuffers {
  BufferDescription percentiles;
  BufferDescription history;
  BufferDescription history_length;
  BufferDescription fast_history;
  BufferDescription signal;
};
inline constexpr RadianceTemporalBuffers specular_temporal_buffers{
    .percentiles = {"specular.percentiles", ViewColors::radiance,
                    "Tenth and ninetieth percentile of the reflections' brightness in every tile "
                    "of 8x8 pixels."},
    .history = {"specular.history", ViewColors::radiance,
                "Accumulated reflections, demodulated, which the next frame goes on "
                "from; distance to what they show (w), metres, negative where no "
                "sample was taken."},
    .history_length =
        {.name = "specular.history_length",
         .colors = ViewColors::heat,
         .description =
             "Frames in the history; how far rectification moved it; mean and deviation of the "
             "brightness of single samples (zw).",
         .aspects = specular_history_length_aspects},
    .fast_history = {"specular.fast_history", ViewColors::radiance,
                     "Reflections of the last few frames alone, demodulated."},
    .signal = {
        .name = "specular.temporal",
        .colors = ViewColors::radiance,
        .description = "Accumulated reflections, demodulated; variance of their brightness (w).",
        .aspects = specular_temporal_aspects}};
inline constexpr RadianceTemporalBuffers indirect_temporal_buffers{
    .percentiles = {"indirect.percentiles", ViewColors::radiance,
                    "Tenth and ninetieth percentile of the indirect light's brightness in every "
                    "tile of 8x8 pixels."},
    .history = {"indirect.history", ViewColors::radiance,
                "Accumulated indirect diffuse light, without albedo, which the next frame goes on "
                "from; negative (w) where no sample was taken."},
    .history_length =
        {.name = "indirect.history_length",
         .colors = ViewColors::heat,
         .description =
             "Frames in the history; how far rectification moved it; mean and deviation of the "
             "brightness of single samples (zw).",
         .aspects = indirect_history_length_aspects},
    .fast_history = {"indirect.fast_history", ViewColors::radiance,
                     "Indirect diffuse light of the last few frames alone."},
    .signal = {
        .name = "indirect.temporal",
        .colors = ViewColors::radiance,
        .description = "Accumulated indirect diffuse light; variance of their brightness (w).",
        .aspects = indirect_temporal_aspects}};

/// Histories that the sampling plan of the next frame reads too.
struct SampleHistories {
  gpu::History visibility;
  gpu::History visibility_length;
  gpu::History specular;
  gpu::History specular_length;
  std::optional<gpu::History> indirect_length;  // of indirect.half_resolution, or the frame's size
};
SampleHistories declare_sample_histories(gpu::FramePlan& plan, const protocol::Settings& settings);

/// A signal accumulated over frames, in this frame.
struct AccumulatedSignal {
  gpu::ImageRef signal;          // the mean and the variance of its noise
  gpu::ImageRef moments;         // of single samples
  gpu::ImageRef history_length;  // frames, and how far rectification moved the mean
  gpu::ImageRef fast_history;    // of the last few frames alone, or how far this frame is from it
  /// What the next frame goes on from: `signal` in 16 bits a channel.
  gpu::ImageRef history;
};

/// Shadow and ambient visibility (x and y; variances z and w).
AccumulatedSignal accumulate_visibility(gpu::FramePlan& plan, const FrameInputs& in,
                                        const Guide& guide, const SampleHistories& histories,
                                        gpu::ImageRef noisy);

/// A channel that carries radiance: reflections or indirect diffuse light. What its passes are
/// called, their images and settings.
struct RadianceChannel {
  std::string name;
  const RadianceTemporalBuffers& buffers;
  const protocol::TemporalSettings& settings;
  gpu::History history;
  gpu::History history_length;
  std::function<std::uint32_t()> flags;  // more of them, shared::temporal_*
  std::function<float()> most_frames;    // of history
  std::function<bool()> rectifies;       // whether what is shown may have changed
};
RadianceChannel specular_channel(const FrameInputs& in, const SampleHistories& histories);
RadianceChannel indirect_channel(gpu::FramePlan& plan, const FrameInputs& in,
                                 const SampleHistories& histories);

/// Demodulated radiance: rgb, and the variance of its luminance in w. Mean and deviation of
/// samples lie beside the length of the history, z and w of `history_length`.
AccumulatedSignal accumulate_radiance(gpu::FramePlan& plan, const FrameInputs& in,
                                      const GBuffer& gbuffer, const Guide& guide,
                                      const RadianceChannel& channel, gpu::ImageRef noisy);

/// Makes `filtered`, a result of the blur, the history that the next frame goes on from.
void feed_visibility_back(gpu::FramePlan& plan, const FrameInputs& in,
                          const AccumulatedSignal& visibility, gpu::ImageRef filtered);
void feed_radiance_back(gpu::FramePlan& plan, const FrameInputs& in, const RadianceChannel& channel,
                        const AccumulatedSignal& radiance, gpu::ImageRef filtered);

/// Gives pixels with a short history the variance of their neighbours (SVGF, section 4.2).
void estimate_visibility_variance(gpu::FramePlan& plan, const FrameInputs& in,
                                  const GBuffer& gbuffer, const Guide& guide,
                                  const AccumulatedSignal& visibility);
void estimate_radiance_variance(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                                const Guide& guide, const RadianceChannel& channel,
                                const AccumulatedSignal& radiance);

}  // namespace heliograph::render
