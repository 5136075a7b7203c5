#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "gpu/frame_plan/bindings.hpp"

namespace heliograph::render::kernels {

/// shaders/post/outline.comp
template <class Stage>
struct OutlineBindings {
  gpu::Read<Stage> instance;                        // r32ui: instance + 1, 0: none
  gpu::ReadBuffer<Stage, std::uint32_t> selection;  // a bit for each instance
  gpu::ReadWrite<Stage> output;                     // rgba8
};
struct OutlineConstants {
  glm::vec4 color;          // sRGB
  glm::uvec2 shown;         // size of `output`, pixels
  glm::uvec2 drawn;         // that of `instance`
  glm::vec2 sample_offset;  // of what pixels of `instance` show from their centres
};
using OutlineJob = gpu::HostPass<OutlineBindings, OutlineConstants>;

/// On all processors. Rows far from everything that is selected cost a look at their instances.
void outline(const OutlineJob& job);

}  // namespace heliograph::render::kernels
