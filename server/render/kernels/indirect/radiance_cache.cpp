#include "render/kernels/indirect/radiance_cache.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <tuple>

namespace heliograph::render::kernels {
namespace {

using glm::uvec3;
using glm::vec3;

constexpr std::uint32_t no_cell = ~0u;
constexpr int slots_of_thread = 4096;

/// shaders/lib/math/random.glsl
uvec3 pcg3d(uvec3 v) {
  v = v * 1664525u + 1013904223u;
  v.x += v.y * v.z;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v ^= v >> 16u;
  v.x += v.y * v.z;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  return v;
}

/// The least integer whose power of two is `size` or more.
int level_of(float size) {
  int exponent = 0;
  // A fraction of at least a half, times a power of two.
  const float fraction = std::frexp(size, &exponent);
  return fraction == 0.5f ? exponent - 1 : exponent;
}

std::uint32_t normal_axis(const vec3& n) {
  const vec3 a = glm::abs(n);
  if (a.x >= a.y && a.x >= a.z) return n.x >= 0.0f ? 0 : 1;
  if (a.y >= a.z) return n.y >= 0.0f ? 2 : 3;
  return n.z >= 0.0f ? 4 : 5;
}

struct CellKey {
  std::uint32_t first;
  std::uint32_t check;
};

CellKey cell_key(const vec3& position, const vec3& normal, int level) {
  const vec3 cell = glm::floor(position * std::ldexp(1.0f, -level));
  uvec3 hashed = pcg3d(uvec3(glm::ivec3(cell)));
  hashed.x += static_cast<std::uint32_t>(level + 64) * 8u + normal_axis(normal);
  hashed = pcg3d(hashed);
  constexpr std::uint32_t buckets = shared::cache_cells / shared::cache_bucket;
  return {hashed.x % buckets * shared::cache_bucket, std::max(hashed.y, 1u)};
}

std::uint32_t find_slot(const std::uint32_t* keys, const CellKey& key) {
  for (std::uint32_t i = 0; i < shared::cache_bucket; ++i) {
    if (keys[key.first + i] == key.check) return key.first + i;
  }
  return no_cell;
}

/// Of a place for its cell; 0: the cell stays where it is.
std::uint32_t priority_of(const vec3& position, std::uint32_t frame_number) {
  const uvec3 random = pcg3d(std::bit_cast<uvec3>(position) + frame_number);
  return random.x % shared::moves_every == 0 ? random.y : 0;
}

}  // namespace

CachedLight CacheReader::find(const vec3& position, const vec3& normal, float t,
                              std::uint32_t order, std::vector<CacheTouch>& touches) const {
  const shared::RadianceCacheConstants& c = constants_;
  const int coarse = level_of(std::max(glm::distance(position, eye_) * c.cell_angle, c.least_size));
  int level = std::clamp(level_of(std::max(t * c.cell_fraction, c.least_size)),
                         coarse - shared::finer_levels, coarse);
  while (true) {
    const CellKey key = cell_key(position, normal, level);
    const std::uint32_t slot = find_slot(keys_, key);
    const std::uint32_t priority = priority_of(position, c.frame_number);
    if (slot == no_cell || priority > 0) {
      touches.push_back({priority, order, key.first, key.check, position, normal});
    }
    if (slot != no_cell) {
      shared::RadianceCell& cell = cells_[slot];
      std::atomic_ref(cell.last_used).store(c.frame_number, std::memory_order_relaxed);
      if (cell.samples > 0) return {cell.direct, cell.indirect, true};
    }
    if (level == coarse) return {};
    level = coarse;
  }
}

void CacheReader::add(std::span<const CacheTouch> touches) {
  const std::lock_guard lock(mutex_);
  touches_.insert(touches_.end(), touches.begin(), touches.end());
}

void CacheReader::apply() {
  std::ranges::sort(touches_, [](const CacheTouch& a, const CacheTouch& b) {
    return std::tie(a.priority, a.order, a.check) < std::tie(b.priority, b.order, b.check);
  });
  for (const CacheTouch& touch : touches_) {
    std::uint32_t slot = find_slot(keys_, {touch.first, touch.check});
    if (slot == no_cell) {
      slot = find_slot(keys_, {touch.first, 0});
      if (slot == no_cell) continue;
      keys_[slot] = touch.check;
      cells_[slot] = {};
      cells_[slot].last_used = constants_.frame_number;
    }
    shared::RadianceCell& cell = cells_[slot];
    if (cell.samples > 0 && touch.priority <= cell.priority) continue;
    cell.position = touch.position;
    cell.normal = touch.normal;
    cell.priority = touch.priority;
  }
  touches_.clear();
}

void radiance_cache_light(const RadianceCacheLightJob& job) {
  for_each_batch(static_cast<int>(job.shadows.count->count), [&](int first, int last) {
    for (int i = first; i < last; ++i) {
      const shared::Ray& ray = job.shadows.rays[i];
      const vec3 light(std::bit_cast<float>(ray.user), std::bit_cast<float>(ray.padding0),
                       std::bit_cast<float>(ray.padding1));
      if (job.occluded[i] || !std::isfinite(light.x + light.y + light.z)) continue;
      job.cells[ray.pixel].new_direct = light;
    }
  });
}

void radiance_cache_blend(const RadianceCacheBlendJob& job) {
  const shared::RadianceCacheConstants& constants = job.constants;
  for_each_range(shared::cache_cells, slots_of_thread, [&](int first, int last) {
    for (int i = first; i < last; ++i) {
      shared::RadianceCell& cell = job.cells[i];
      if (job.keys[i] == 0 || cell.updated == 0) continue;
      cell.samples = std::min(cell.samples + 1, constants.most_samples);
      const float later = 2.0f / static_cast<float>(cell.samples + 1);
      const float weight = std::min(std::max(later, constants.least_weight), 1.0f);
      cell.direct = glm::mix(cell.direct, cell.new_direct, weight);
      cell.indirect = glm::mix(cell.indirect, cell.new_indirect, weight);
    }
  });
  job.keys[shared::cache_counts + (constants.frame_number + 1) % 2] = 0;
}

}  // namespace heliograph::render::kernels
