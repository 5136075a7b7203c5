#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "render/api/frame_values.hpp"
#include "render/frame/engine_parts.hpp"
#include "render/frame/frame.hpp"

namespace heliograph::render {

inline constexpr std::string_view picture_name = "output";
inline constexpr std::string_view radiance_name = "output.radiance";

/// A compiled frame with all that it holds on to: one scene at one size, made of the passes that
/// the settings asked for when it was made.
struct Drawing {
  /// References in `inputs`, and `constants_buffer`, outlive the drawing.
  Drawing(const Engine::Parts& parts, const FrameInputs& inputs,
          const gpu::Buffer& constants_buffer, VkExtent2D extent);

  /// The image of that name as of the last frame, or null.
  const gpu::Image* find(std::string_view buffer) const;

  FrameInputs inputs;
  gpu::DescriptorPool pool;
  gpu::FramePlan plan;
  FrameOutputs outputs;
  std::vector<BufferInfo> buffers;  // that a view or a capture may name, the picture first

 private:
  void share_sets(const Engine::Parts& parts, const gpu::Buffer& constants_buffer);
  void list_buffers();
};

}  // namespace heliograph::render
