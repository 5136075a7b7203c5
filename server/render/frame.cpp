#include "render/frame.hpp"

#include "render/accumulate.hpp"
#include "render/compose.hpp"
#include "render/gbuffer.hpp"
#include "render/present.hpp"
#include "render/skybox.hpp"
#include "render/trace_visibility.hpp"

namespace heliograph::render {

// The stages of the paper's section 3, in its order; the prefilter ran when the environment came.
FrameOutputs declare_frame(gpu::FramePlan& plan, const FrameInputs& in) {
  const GBuffer gbuffer = rasterize_gbuffer(plan, in);

  const gpu::ImageRef shadows = trace_shadows(plan, in, gbuffer);
  const gpu::ImageRef ambient = trace_ambient(plan, in, gbuffer);

  const gpu::ImageRef background = draw_skybox(plan, in, gbuffer);
  const gpu::ImageRef hdr = compose(plan, in, gbuffer, shadows, ambient, background);

  const gpu::History accumulated = accumulate(plan, in, hdr);
  const gpu::ImageRef picture = present(plan, in, accumulated.current);
  return {accumulated, picture};
}

}  // namespace heliograph::render
