#include "render/kernels/section/section.hpp"

namespace heliograph::render::kernels {

void section_color(const SectionColorJob& job) {
  for_each_range(job.height, 16, [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      const SectionCap* const caps = job.caps + static_cast<std::ptrdiff_t>(y) * job.width;
      auto* const radiance = job.radiance.row<glm::vec4>(static_cast<std::uint32_t>(y));
      for (int x = 0; x < job.width; ++x) {
        if (caps[x].x) radiance[x] = {job.constants.cap_color, 1.0f};
      }
    }
  });
}

}  // namespace heliograph::render::kernels
