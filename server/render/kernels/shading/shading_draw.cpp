#include "render/kernels/shading/shading_draw.hpp"

#include <cmath>
#include <glm/gtc/packing.hpp>

#include "render/api/octahedral.hpp"
#include "render/kernels/common/met_triangle.hpp"

namespace heliograph::render::kernels {
namespace {

class Shading {
 public:
  explicit Shading(const ShadingDrawJob& job) : job_(job), mode_(job.constants.mode) {}

  void draw(const shared::Ray& ray, const shared::Hit& hit) const {
    const std::uint32_t x = ray.pixel & 0xffffu, y = ray.pixel >> 16;
    if (mode_ == shared::shading_wireframe) {
      if (shows_edge(ray, hit)) draw_edge(x, y);
    } else if (mode_ == shared::shading_clay) {
      store(x, y, glm::vec3(shared::clay_albedo), {shared::clay_roughness, 0.0f, 0.0f, 0.0f});
    } else {
      store(x, y, flat_color(x, y, ray, hit), {1.0f, 0.0f, 1.0f, 0.0f});
    }
  }

 private:
  template <typename Texel>
  static Texel& texel(const gpu::HostView& image, std::uint32_t x, std::uint32_t y) {
    return image.row<Texel>(y)[x];
  }

  bool shows_edge(const shared::Ray& ray, const shared::Hit& hit) const {
    const MetTriangle t = met_triangle(job_.scene, hit);
    const glm::vec3 at = t.position();
    const glm::vec3 position = ray.origin + hit.t * ray.direction;
    const float view_z = -(job_.frame.view * glm::vec4(position, 1.0f)).z;
    return shared::is_on_edge(t.world * (t.a.position - at), t.world * (t.b.position - at),
                              t.world * (t.c.position - at), ray.direction,
                              pixel_footprint(view_z));
  }

  float pixel_footprint(float view_z) const {
    const shared::FrameConstants& frame = job_.frame;
    const float height = 2.0f * std::abs(frame.unproject.y) / static_cast<float>(frame.extent.y);
    return (frame.flags & shared::frame_orthographic) != 0 ? height : height * view_z;
  }

  void draw_edge(std::uint32_t x, std::uint32_t y) const {
    std::uint32_t& stored = texel<std::uint32_t>(job_.base_color, x, y);
    const glm::vec4 root = glm::unpackUnorm4x8(stored);
    const glm::vec3 color = glm::vec3(root) * glm::vec3(root);
    const float brightness = glm::dot(color, glm::vec3(0.2126f, 0.7152f, 0.0722f));
    const float line = brightness < shared::dark_surface ? std::sqrt(shared::bright_line) : 0.0f;
    stored = glm::packUnorm4x8(glm::vec4(glm::vec3(line), root.w));
    emit_nothing(x, y);
  }

  glm::vec3 seen_normal(const glm::vec3& normal, const glm::vec3& direction) const {
    const glm::vec3 camera_up(job_.frame.inverse_view[1]);
    const glm::vec3 right = glm::normalize(glm::cross(camera_up, -direction));
    const glm::vec3 up = glm::cross(-direction, right);
    return {glm::dot(normal, right), glm::dot(normal, up), -glm::dot(normal, direction)};
  }

  glm::vec3 flat_color(std::uint32_t x, std::uint32_t y, const shared::Ray& ray,
                       const shared::Hit& hit) const {
    if (mode_ == shared::shading_uv_checker) {
      return shared::uv_checker_color(met_triangle(job_.scene, hit).uv());
    }
    const auto& stored = texel<const glm::vec4>(job_.normals, x, y);
    const glm::vec3 normal = octahedral_decode(glm::vec2(stored));
    if (mode_ == shared::shading_matcap) {
      return shared::matcap_color(seen_normal(normal, ray.direction));
    }
    const glm::vec3 shown = 0.5f * normal + 0.5f;
    return shown * shown;
  }

  void store(std::uint32_t x, std::uint32_t y, const glm::vec3& color,
             const glm::vec4& kind) const {
    texel<std::uint32_t>(job_.base_color, x, y) =
        glm::packUnorm4x8(glm::vec4(glm::sqrt(color), 1.0f));
    texel<std::uint32_t>(job_.surface, x, y) = glm::packUnorm4x8(kind);
    emit_nothing(x, y);
  }

  void emit_nothing(std::uint32_t x, std::uint32_t y) const {
    texel<std::uint64_t>(job_.emissive, x, y) =
        glm::packHalf4x16(glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
  }

  const ShadingDrawJob& job_;
  std::uint32_t mode_;
};

}  // namespace

void shading_draw(const ShadingDrawJob& job) {
  const Shading shading(job);
  for_each_batch(static_cast<int>(job.rays.count->count), [&](int first, int last) {
    for (int i = first; i < last; ++i) {
      const shared::Hit& hit = job.hits[i];
      if (hit.instance != shared::hit_none) shading.draw(job.rays.rays[i], hit);
    }
  });
}

}  // namespace heliograph::render::kernels
