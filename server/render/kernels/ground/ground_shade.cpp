#include "render/kernels/common/pixel_rays.hpp"
#include "render/kernels/common/tile.hpp"
#include "render/kernels/ground/ground.hpp"
#include "render/kernels/ground/ground_factor.hpp"

namespace heliograph::render::kernels {

void ground_shade(const GroundShadeJob& job) {
  const PixelRays rays(job.frame);
  for_each_range(job.height, 4, [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      const auto row = static_cast<std::uint32_t>(y);
      const float* const motion = job.motion.row<const float>(row);
      float* const background = job.background.row<float>(row);
      for (int x = 0; x < job.width; ++x) {
        if (motion[4 * x + 3] > 0.0f) continue;
        const auto [origin, direction] = rays.through(x, y);
        const float factor = ground_factor(job.frame.ground, job.shade, origin, direction);
        if (factor < 1.0f) {
          for (int channel = 0; channel < 3; ++channel) background[4 * x + channel] *= factor;
        }
      }
    }
  });
}

}  // namespace heliograph::render::kernels
