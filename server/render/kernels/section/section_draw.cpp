#include <cmath>
#include <glm/gtc/packing.hpp>

#include "render/api/octahedral.hpp"
#include "render/kernels/common/pixel_rays.hpp"
#include "render/kernels/common/tile.hpp"
#include "render/kernels/section/section.hpp"

namespace heliograph::render::kernels {
namespace {

/// Where the rays of pixels meet planes.
class CapView {
 public:
  explicit CapView(const SectionDrawJob& job) : job_(job), frame_(job.frame), rays_(job.frame) {}

  void draw(int x, int y, const SectionCap& cap) const {
    const glm::vec4& plane = job_.constants.planes[cap.x - 1];
    const glm::vec3 position = point_on(plane, x, y);
    const float view_z = view_z_of(position);
    const glm::vec2 slope(view_z_of(point_on(plane, x + 1, y)) - view_z,
                          view_z_of(point_on(plane, x, y + 1)) - view_z);
    const glm::vec2 normal = octahedral_encode(glm::vec3(plane));
    texel<glm::vec4>(job_.normals, x, y) = {normal, normal};
    texel<std::uint32_t>(job_.base_color, x, y) =
        glm::packUnorm4x8(glm::vec4(glm::sqrt(job_.constants.cap_color), 1.0f));
    texel<std::uint32_t>(job_.surface, x, y) = glm::packUnorm4x8(glm::vec4(1.0f, 0.0f, 1.0f, 0.0f));
    texel<glm::vec4>(job_.motion, x, y) = motion_of(position, view_z);
    texel<std::uint64_t>(job_.emissive, x, y) = glm::packHalf4x16({0.0f, 0.0f, 0.0f, 1.0f});
    texel<glm::vec2>(job_.depth_slope, x, y) = glm::clamp(slope, -view_z, view_z);
    texel<std::uint32_t>(job_.instance, x, y) = cap.y;
  }

 private:
  template <typename Texel>
  static Texel& texel(const gpu::HostView& image, int x, int y) {
    return image.row<Texel>(static_cast<std::uint32_t>(y))[x];
  }

  glm::vec3 point_on(const glm::vec4& plane, int x, int y) const {
    const PixelRay ray = rays_.through(x, y);
    const glm::vec3 normal(plane), direction = glm::normalize(ray.direction);
    const float rise = glm::dot(normal, direction);
    const float t =
        (plane.w - glm::dot(normal, ray.origin)) / (std::abs(rise) < 1e-6f ? 1e-6f : rise);
    return ray.origin + t * direction;
  }

  float view_z_of(const glm::vec3& position) const {
    return -(frame_.view * glm::vec4(position, 1.0f)).z;
  }

  glm::vec4 motion_of(const glm::vec3& position, float view_z) const {
    const glm::vec4 now = frame_.unjittered * glm::vec4(position, 1.0f);
    const glm::vec4 before = frame_.previous_unjittered * glm::vec4(position, 1.0f);
    const float z_before = -(frame_.previous_view * glm::vec4(position, 1.0f)).z;
    const glm::vec2 moved = (glm::vec2(before) / before.w - glm::vec2(now) / now.w) * 0.5f;
    return {moved, z_before - view_z, view_z};
  }

  const SectionDrawJob& job_;
  const shared::FrameConstants& frame_;
  PixelRays rays_;
};

}  // namespace

void section_draw(const SectionDrawJob& job) {
  const CapView view(job);
  for_each_range(job.height, 4, [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      const SectionCap* const caps = job.caps + static_cast<std::ptrdiff_t>(y) * job.width;
      for (int x = 0; x < job.width; ++x) {
        if (caps[x].x) view.draw(x, y, caps[x]);
      }
    }
  });
}

}  // namespace heliograph::render::kernels
