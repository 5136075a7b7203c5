#include <algorithm>
#include <bit>
#include <cmath>

#include "render/kernels/common/random.hpp"
#include "render/kernels/ground/ground.hpp"

namespace heliograph::render::kernels {
namespace {

constexpr int map_side = static_cast<int>(shared::ground_side);
constexpr int map_grain = 1024;

float ground_falloff(const shared::GroundLight& light, const glm::vec3& direction, float away) {
  const float squared = away * away;
  float share = std::max(direction.y, 0.0f) / squared;
  if (light.range > 0.0f) {
    const float q = squared / (light.range * light.range);
    share *= std::clamp(1.0f - q * q, 0.0f, 1.0f);
  }
  const float cosine = -glm::dot(light.axis, direction);
  const float cone = std::clamp(cosine * light.scale + light.offset, 0.0f, 1.0f);
  return share * (light.kind == shared::ground_light_area ? cone : cone * cone);
}

shared::Ray ray_toward(const shared::GroundLight& light, const glm::vec3& origin,
                       std::uint32_t texel) {
  shared::Ray ray{.origin = origin,
                  .t_min = 0.0f,
                  .direction = light.place,
                  .t_max = 1e30f,
                  .pixel = texel,
                  .user = 0,
                  .padding0 = 0,
                  .padding1 = 0};
  float weight = light.weight;
  if (light.kind != shared::ground_light_far) {
    const glm::vec3 to_light = light.place - origin;
    const float away = std::max(glm::length(to_light), 1e-4f);
    ray.direction = to_light / away;
    ray.t_max = away * 0.999f;
    weight *= ground_falloff(light, ray.direction, away);
  }
  if (!(weight > 0.0f)) ray.t_max = 0.0f;
  ray.user = std::bit_cast<std::uint32_t>(std::max(weight, 0.0f));
  return ray;
}

void rays_of_texel(const GroundRaysJob& job, std::uint32_t texel) {
  const shared::FrameConstants& frame = job.frame;
  const std::uint32_t first = shared::first_ground_light(texel);
  const glm::vec2 corner(texel % shared::ground_side, texel / shared::ground_side);
  for (std::uint32_t i = 0; i < shared::ground_rays; ++i) {
    const std::uint32_t number = frame.sample_index * shared::ground_rays + i;
    const glm::uvec3 word = pcg3d({texel, frame.seed, number + 1u});
    const glm::vec2 within = glm::vec2(word.x >> 8u, word.y >> 8u) * 0x1p-24f;
    const glm::vec2 at = (corner + within) * (2.0f / map_side) - 1.0f;
    const glm::vec3 origin =
        glm::vec3(frame.ground) + frame.ground.w * glm::vec3(at.x, 1e-5f, at.y);
    const std::uint32_t light =
        (first + number * shared::ground_light_step) % shared::ground_lights;
    job.rays.rays[texel * shared::ground_rays + i] = ray_toward(job.lights[light], origin, texel);
  }
}

}  // namespace

void ground_rays(const GroundRaysJob& job) {
  for_each_range(map_side * map_side, map_grain, [&](int first, int last) {
    for (int texel = first; texel < last; ++texel) {
      rays_of_texel(job, static_cast<std::uint32_t>(texel));
    }
  });
  job.rays.count->count = shared::ground_side * shared::ground_side * shared::ground_rays;
  job.rays.end();
}

void ground_gather(const GroundGatherJob& job) {
  const float kept = job.constants.kept;
  for_each_range(map_side * map_side, map_grain, [&](int first, int last) {
    for (int texel = first; texel < last; ++texel) {
      shared::GroundTexel known{0.0f, 0.0f};
      if (kept > 0.0f) {
        known = job.texels[texel];
        known.arrived *= kept;
        known.sent *= kept;
      }
      for (std::uint32_t i = 0; i < shared::ground_rays; ++i) {
        const std::uint32_t index = static_cast<std::uint32_t>(texel) * shared::ground_rays + i;
        const float light = std::bit_cast<float>(job.rays[index].user);
        known.sent += light;
        if (job.occluded[index] == 0) known.arrived += light;
      }
      job.texels[texel] = known;
    }
  });
}

void ground_filter(const GroundFilterJob& job) {
  const int radius = job.constants.radius;
  constexpr int row_grain = 4;
  for_each_range(map_side, row_grain, [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      for (int x = 0; x < map_side; ++x) {
        float arrived = 0.0f, sent = 0.0f;
        for (int v = std::max(y - radius, 0); v <= std::min(y + radius, map_side - 1); ++v) {
          for (int u = std::max(x - radius, 0); u <= std::min(x + radius, map_side - 1); ++u) {
            const shared::GroundTexel& texel = job.texels[v * map_side + u];
            arrived += texel.arrived;
            sent += texel.sent;
          }
        }
        job.shade[y * map_side + x] = sent > 0.0f ? arrived / sent : 1.0f;
      }
    }
  });
}

}  // namespace heliograph::render::kernels
