#include <cmath>

#include "render/kernels/blend/blended.hpp"
#include "render/kernels/simd/rows.hpp"

namespace heliograph::render::kernels {

void blended_over(const BlendedOverJob& job) {
  for_each_band(job.height, [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      const auto row = static_cast<std::uint32_t>(y);
      const float* seen = job.transmittance.row<const float>(row);
      const float* own = job.radiance.row<const float>(row);
      const float* mirrored = job.specular.row<const float>(row);
      float* to = job.frame.row<float>(row);
      for (int x = 0; x < job.width; ++x, seen += 4, own += 4, mirrored += 4, to += 4) {
        if (seen[0] == 1.0f && seen[1] == 1.0f && seen[2] == 1.0f) continue;
        glm::vec3 over(own[0] + mirrored[0], own[1] + mirrored[1], own[2] + mirrored[2]);
        // One bad pixel must not spread through the history.
        if (!std::isfinite(over.x + over.y + over.z)) over = glm::vec3(0.0f);
        for (int c = 0; c < 3; ++c) to[c] = to[c] * seen[c] + over[c];
      }
    }
  });
}

}  // namespace heliograph::render::kernels
