#include <algorithm>

#include "render/kernels/blend/blended.hpp"
#include "render/kernels/common/pixel_band.hpp"
#include "render/kernels/simd/rows.hpp"

namespace heliograph::render::kernels {
namespace {

glm::ivec2 unpacked(std::uint32_t pixel) {
  return {pixel & 0xffffu, pixel >> 16u};
}

/// Scenes with such volumes are rare, and their rays dear: one pixel after the other.
class BandSharing {
 public:
  explicit BandSharing(const BlendedBandsJob& job) : job_(job), turn_(band_turn(job.frame)) {}

  void add(std::uint32_t ray) const {
    const glm::ivec2 pixel = unpacked(job_.rays.rays[ray].pixel);
    const float* const through = texel(job_.through, pixel);
    glm::vec3 light(through[0], through[1], through[2]);
    const std::uint32_t instance = instance_at(pixel);
    if (splits_light(instance)) light = with_other_bands(light, instance, pixel);
    float* const sum = job_.radiance.row<float>(static_cast<std::uint32_t>(pixel.y)) + 4 * pixel.x;
    for (int c = 0; c < 3; ++c) sum[c] += light[c];
  }

 private:
  static const float* texel(const gpu::HostView& image, glm::ivec2 at) {
    return image.row<const float>(static_cast<std::uint32_t>(at.y)) + 4 * at.x;
  }

  /// Of a pixel's surface.
  std::uint32_t instance_at(glm::ivec2 pixel) const {
    const glm::uvec2 at(pixel);
    return job_.chosen[at.y * job_.frame.extent.x + at.x].instance;
  }

  bool splits_light(std::uint32_t instance) const {
    const std::uint32_t mesh = job_.scene.instances[instance].mesh;
    const std::uint32_t number = job_.scene.materials[job_.scene.meshes[mesh].material].layer;
    const Layer& layer = job_.scene.layers[number];
    return layer.refraction != 0.0f && layer.dispersion > 0.0f;
  }

  glm::vec3 with_other_bands(glm::vec3 light, std::uint32_t instance, glm::ivec2 pixel) const {
    const int own = band_color(pixel.x, pixel.y, turn_);
    glm::vec3 sum = light, count(0.0f);
    count[own] = 1.0f;
    const glm::ivec2 first = glm::max(pixel - 1, 0);
    const glm::ivec2 last = glm::min(pixel + 1, glm::ivec2(job_.frame.extent) - 1);
    for (int y = first.y; y <= last.y; ++y) {
      for (int x = first.x; x <= last.x; ++x) {
        const int color = band_color(x, y, turn_);
        const float* const near = texel(job_.through, {x, y});
        if (color == own || near[3] <= 0.0f || instance_at({x, y}) != instance) continue;
        sum[color] += near[color];
        count[color] += 1.0f;
      }
    }
    const bool complete = glm::all(glm::greaterThan(count, glm::vec3(0.0f)));
    return complete ? sum / (3.0f * count) : light;
  }

  const BlendedBandsJob& job_;
  std::uint32_t turn_;
};

}  // namespace

void blended_bands(const BlendedBandsJob& job) {
  const BandSharing sharing(job);
  for_each_batch(static_cast<int>(job.rays.count->count), [&](int first, int last) {
    for (int i = first; i < last; ++i) sharing.add(static_cast<std::uint32_t>(i));
  });
}

void blended_empty(const BlendedEmptyJob& job) {
  for_each_batch(static_cast<int>(job.rays.count->count), [&](int first, int last) {
    for (int i = first; i < last; ++i) {
      const glm::ivec2 pixel = unpacked(job.rays.rays[i].pixel);
      std::fill_n(job.emptied.row<float>(static_cast<std::uint32_t>(pixel.y)) + 4 * pixel.x, 4,
                  0.0f);
    }
  });
}

}  // namespace heliograph::render::kernels
