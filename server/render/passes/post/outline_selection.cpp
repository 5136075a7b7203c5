#include "render/passes/post/outline_selection.hpp"

#include "render/kernels/post/outline.hpp"
#include "render/resources/moving/moving_scene.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {
namespace {

constexpr glm::vec4 outline_color{1.0f, 0.55f, 0.08f, 1.0f};  // sRGB

/// From the centre of a pixel to what it shows, pixels: the image is shifted by the jitter.
glm::vec2 sample_offset(const shared::FrameConstants& frame) {
  const glm::vec2 scale(frame.unproject), shift(frame.unproject.z, frame.unproject.w);
  return 0.5f * glm::vec2(frame.extent) * shift / scale;
}

}  // namespace

void outline_selection(gpu::FramePlan& plan, const FrameInputs& in, gpu::ImageRef instance,
                       gpu::ImageRef output) {
  plan.pass("outline", in.program(shaders::outline))
      .bind<kernels::OutlineBindings>(
          {.instance = instance, .selection = plan.import(in.moving.selection()), .output = output})
      .constants([in] {
        return kernels::OutlineConstants{outline_color, size_of(in.shown), in.constants.extent,
                                         sample_offset(in.constants)};
      })
      .when([&moving = in.moving] { return moving.has_selection(); })
      .dispatch(in.shown)
      .host(kernels::outline);
}

}  // namespace heliograph::render
