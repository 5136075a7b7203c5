#include "render/kernels/common/tile.hpp"
#include "render/kernels/ground/ground.hpp"
#include "render/kernels/ground/ground_factor.hpp"

namespace heliograph::render::kernels {
namespace {

class GroundView {
 public:
  explicit GroundView(const GroundShadeJob& job)
      : job_(job),
        orthographic_((job.frame.flags & shared::frame_orthographic) != 0),
        scale_(2.0f / glm::vec2(job.frame.extent)) {}

  /// Of the background at a pixel.
  float factor(int x, int y) const {
    const shared::FrameConstants& frame = job_.frame;
    const glm::vec2 ndc = (glm::vec2(x, y) + 0.5f) * scale_ - 1.0f;
    const glm::vec4& u = frame.unproject;
    const glm::vec2 slope = ndc * glm::vec2(u.x, u.y) + glm::vec2(u.z, u.w);
    const glm::vec3 away = orthographic_ ? glm::vec3(0.0f, 0.0f, -1.0f) : glm::vec3(slope, -1.0f);
    const glm::vec3 view_origin = orthographic_ ? glm::vec3(slope, 0.0f) : glm::vec3(0.0f);
    const glm::vec3 origin(frame.inverse_view * glm::vec4(view_origin, 1.0f));
    return ground_factor(frame.ground, job_.shade, origin, glm::mat3(frame.inverse_view) * away);
  }

 private:
  const GroundShadeJob& job_;
  bool orthographic_;
  glm::vec2 scale_;
};

}  // namespace

void ground_shade(const GroundShadeJob& job) {
  const GroundView view(job);
  for_each_range(job.height, 4, [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      const auto row = static_cast<std::uint32_t>(y);
      const float* const motion = job.motion.row<const float>(row);
      float* const background = job.background.row<float>(row);
      for (int x = 0; x < job.width; ++x) {
        if (motion[4 * x + 3] > 0.0f) continue;
        const float factor = view.factor(x, y);
        if (factor < 1.0f) {
          for (int channel = 0; channel < 3; ++channel) background[4 * x + channel] *= factor;
        }
      }
    }
  });
}

}  // namespace heliograph::render::kernels
