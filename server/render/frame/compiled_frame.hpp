#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "render/api/frame_values.hpp"
#include "render/frame/engine_parts.hpp"
#include "render/frame/frame.hpp"
#include "render/frame/frame_constants.hpp"
#include "render/passes/jpeg/encode_jpeg.hpp"
#include "render/resources/environment/background.hpp"

namespace heliograph::render {

/// The plan of a frame with the resources that it keeps alive: one scene at one size, made of the
/// passes that the settings asked for when it was made.
struct CompiledFrame {
  /// References in `inputs`, and the others, outlive this. `keeps_buffers`: whether all images can
  /// be read after a frame, or just the output and the denoisers' histories. `jpeg`: of each frame,
  /// none where its pixels come back.
  CompiledFrame(const Engine::Parts& parts, const FrameInputs& inputs,
                const FrameConstantsSlots& constants_buffers, VkExtent2D extent, bool keeps_buffers,
                const std::optional<JpegRequest>& jpeg);

  /// An image as of the last frame, and how much of it, from the first texel, was drawn.
  struct DrawnImage {
    const gpu::Image& whole;
    VkExtent2D drawn;
  };
  DrawnImage latest(gpu::ImageRef image) const { return {plan.latest(image), plan.drawn(image)}; }
  /// That of a name, if there is one that was kept.
  std::optional<DrawnImage> find(std::string_view buffer) const;

  FrameInputs inputs;
  std::shared_ptr<const Background> background;  // null: the environment as it is
  gpu::DescriptorPool pool;
  gpu::FramePlan plan;
  FrameOutputs outputs;
  std::optional<EncodedOutput> encoded;  // absent where the device does not encode
  bool has_frame = false;                // the output is that of a finished frame
  /// uniform_mean_weight() of the frame that began last, which did not write outputs.mean_weight.
  std::optional<float> uniform_weight;
  std::vector<BufferInfo> buffers;  // that a view or a capture may name, the output first

 private:
  void share_sets(const Engine::Parts& parts, const FrameConstantsSlots& constants_buffers);
  void list_buffers();
};

}  // namespace heliograph::render
