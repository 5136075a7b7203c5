#include "render/kernels/lights/reaching_lights.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace heliograph::render::kernels {
namespace {

/// With fewer lights looking for them takes longer than shading.
constexpr std::size_t least_lights = 16;
/// Of the numbers that positions are made of, for rounding.
constexpr float tolerance = 1e-5f;

bool has_range(const shared::Light& light) {
  return light.type != shared::light_directional && light.range > 0.0f;
}

}  // namespace

ReachingLights::ReachingLights(std::span<const shared::Light> all,
                               const shared::FrameConstants& frame)
    : all_(all),
      frame_(frame),
      culls_(all.size() > least_lights && std::ranges::any_of(all, has_range)) {
  if (!culls_) return;
  reaches_.reserve(all.size());
  for (const shared::Light& light : all) {
    const float range = light.range * (1.0f + tolerance);
    reaches_.push_back({light.position,
                        has_range(light) ? range * range : std::numeric_limits<float>::infinity()});
  }
}

ReachingLights::Box ReachingLights::bounds(const Tile& tile, float nearest, float farthest) const {
  constexpr float far_away = std::numeric_limits<float>::max();
  Box box{glm::vec3(far_away), glm::vec3(-far_away)};
  const bool orthographic = (frame_.flags & shared::frame_orthographic) != 0;
  const glm::vec2 size(frame_.extent);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec2 pixel(corner & 1 ? tile.right : tile.left, corner & 2 ? tile.bottom : tile.top);
    const float view_z = corner & 4 ? farthest : nearest;
    const glm::vec2 slope =
        (pixel / size * 2.0f - 1.0f) * glm::vec2(frame_.unproject.x, frame_.unproject.y) +
        glm::vec2(frame_.unproject.z, frame_.unproject.w);
    const glm::vec2 across = orthographic ? slope : slope * view_z;
    const glm::vec3 at(frame_.inverse_view * glm::vec4(across, -view_z, 1.0f));
    box.low = glm::min(box.low, at);
    box.high = glm::max(box.high, at);
  }
  const glm::vec3 largest = glm::max(glm::abs(box.low), glm::abs(box.high));
  const glm::vec3 eye = glm::abs(glm::vec3(frame_.inverse_view[3]));
  const glm::vec3 margin = (largest + eye + glm::vec3(farthest)) * tolerance;
  return {box.low - margin, box.high + margin};
}

std::span<const shared::Light> ReachingLights::of(const Tile& tile, const gpu::HostView& motion,
                                                  std::vector<shared::Light>& found) const {
  if (!culls_) return all_;
  float nearest = std::numeric_limits<float>::max(), farthest = 0.0f;
  for (int y = tile.top; y < tile.bottom; ++y) {
    const auto* const row = motion.row<const float>(static_cast<std::uint32_t>(y));
    for (int x = tile.left; x < tile.right; ++x) {
      const float view_z = row[4 * x + 3];
      if (!(view_z > 0.0f)) continue;
      nearest = std::min(nearest, view_z);
      farthest = std::max(farthest, view_z);
    }
  }
  found.clear();
  if (farthest <= 0.0f) return found;
  const Box box = bounds(tile, nearest, farthest);
  for (std::size_t i = 0; i < reaches_.size(); ++i) {
    const glm::vec3& at = reaches_[i].position;
    const glm::vec3 away = glm::max(glm::max(box.low - at, at - box.high), glm::vec3(0.0f));
    if (!(glm::dot(away, away) > reaches_[i].squared_range)) found.push_back(all_[i]);
  }
  return found;
}

}  // namespace heliograph::render::kernels
