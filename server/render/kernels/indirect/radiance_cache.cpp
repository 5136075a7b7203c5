#include "render/kernels/indirect/radiance_cache.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <tuple>

#include "hwy/cache_control.h"
#include "render/kernels/indirect/cell_level.hpp"
#include "render/kernels/indirect/path_guide.hpp"

namespace heliograph::render::kernels {
namespace {

using glm::uvec3;
using glm::vec3;

constexpr std::uint32_t no_cell = ~0u;
constexpr int slots_of_thread = 4096;

CellKey cell_key(const SeenPlace& at, int level) {
  const vec3 cell = glm::floor(at.position * std::ldexp(1.0f, -level));
  uvec3 hashed = pcg3d(uvec3(glm::ivec3(cell)));
  const std::uint32_t side = normal_axis(at.normal) + (at.is_back ? 6u : 0u);
  hashed.x += static_cast<std::uint32_t>(level + 64) * 16u + side;
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

/// Of a half of a split cell.
CellKey half_key(const CellKey& whole, bool in_front) {
  const uvec3 hashed = pcg3d({whole.first, whole.check, in_front ? 1u : 2u});
  constexpr std::uint32_t buckets = shared::cache_cells / shared::cache_bucket;
  return {hashed.x % buckets * shared::cache_bucket, std::max(hashed.y, 1u)};
}

vec3 raised(const vec3& position, const vec3& normal, float size) {
  return position + normal * (shared::cell_lift * size);
}

/// Of a place for its cell; 0: the cell stays where it is.
std::uint32_t priority_of(const vec3& position, std::uint32_t frame_number) {
  const uvec3 random = pcg3d(std::bit_cast<uvec3>(position) + frame_number);
  return random.x % shared::moves_every == 0 ? random.y : 0;
}

}  // namespace

CacheReader::Lookup CacheReader::begin(const CacheQuery& ray) const {
  const shared::RadianceCacheConstants& c = constants_;
  Lookup made;
  made.coarse = CellScale{eye_, c.cell_angle, c.least_size}.level_at(ray.at.position);
  const int level = std::clamp(level_of(std::max(ray.t * c.cell_fraction, c.least_size)),
                               made.coarse - shared::finer_levels, made.coarse);
  look_at(ray, level, made);
  hwy::Prefetch(keys_ + made.key.first);
  return made;
}

void CacheReader::look_at(const CacheQuery& ray, int level, Lookup& lookup) const {
  lookup.level = level;
  lookup.splits = 0;
  lookup.key = cell_key(ray.at, level);
}

void CacheReader::follow_splits(const CacheQuery& ray, Lookup& lookup) const {
  const vec3 place = raised(ray.at.position, ray.at.normal, std::ldexp(1.0f, lookup.level));
  for (; lookup.splits < shared::most_splits && lookup.slot != no_cell; ++lookup.splits) {
    const shared::RadianceCell& cell = cells_[lookup.slot];
    if (cell.state != shared::cell_split) return;
    use(lookup.slot);
    lookup.key = half_key(lookup.key, glm::dot(place - cell.position, cell.normal) > 0.0f);
    lookup.slot = find_slot(keys_, lookup.key);
  }
}

void CacheReader::touch(const CacheQuery& ray, const Lookup& lookup,
                        std::vector<CacheTouch>& touches) const {
  const std::uint32_t priority = priority_of(ray.at.position, constants_.frame_number);
  if (lookup.slot == no_cell || priority > 0) {
    touches.push_back({priority, ray.order, lookup.key.first, lookup.key.check, lookup.splits,
                       std::ldexp(1.0f, lookup.level), ray.at.position, ray.at.normal});
  }
  if (lookup.slot != no_cell) use(lookup.slot);
}

CachedLight CacheReader::read(const CacheQuery& ray, Lookup& lookup,
                              std::vector<CacheTouch>& touches) const {
  while (true) {
    follow_splits(ray, lookup);
    touch(ray, lookup, touches);
    if (lookup.slot != no_cell) {
      const shared::RadianceCell& cell = cells_[lookup.slot];
      if (cell.samples > 0) {
        return {cell.direct, cell.indirect, std::ldexp(1.0f, lookup.level)};
      }
    }
    if (lookup.level == lookup.coarse) return {};
    look_at(ray, lookup.coarse, lookup);
    lookup.slot = find_slot(keys_, lookup.key);
  }
}

// All rays wait for memory together.
void CacheReader::find(std::span<const CacheQuery> rays, CachedLight* light,
                       std::vector<CacheTouch>& touches) const {
  std::array<Lookup, most_cache_queries> lookups;
  for (std::size_t i = 0; i < rays.size(); ++i) lookups[i] = begin(rays[i]);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    lookups[i].slot = find_slot(keys_, lookups[i].key);
    if (lookups[i].slot != no_cell) hwy::Prefetch(cells_ + lookups[i].slot);
  }
  for (std::size_t i = 0; i < rays.size(); ++i) light[i] = read(rays[i], lookups[i], touches);
}

void CacheReader::use(std::uint32_t slot) const {
  // A store would take the cell from the other processors' caches, even of the same value.
  const std::atomic_ref last_used(cells_[slot].last_used);
  if (last_used.load(std::memory_order_relaxed) != constants_.frame_number) {
    last_used.store(constants_.frame_number, std::memory_order_relaxed);
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
    const bool is_new = cell.samples == 0;
    if (!is_new && touch.priority <= cell.priority) continue;
    cell.position = touch.position;
    cell.normal = touch.normal;
    cell.priority = touch.priority;
    cell.moved = is_new ? 0 : 1;
    if (!is_new) continue;
    cell.size = touch.size;
    cell.splits = touch.splits;
    cell.anchor = raised(touch.position, touch.normal, touch.size);
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
      shared::RadianceCell& cell = job.cells[ray.pixel % shared::cache_cells];
      if (cell.state != shared::cell_updated) continue;
      if ((ray.pixel & shared::cache_emissive_ray) == 0) {
        cell.new_direct = light;
      } else if (cell.new_indirect.x >= 0.0f) {
        cell.new_indirect += light;
      }
    }
  });
}

namespace {

void split(shared::RadianceCell& cell) {
  cell.position = cell.anchor;
  cell.normal = cell.new_direct;
  cell.direct = cell.indirect = vec3(0.0f);
  cell.samples = 0;
  cell.state = shared::cell_split;
}

/// Cells whose gathering rays have brought something. The guide learns from them in the order of
/// their slots, which does not depend on threads.
class LearntCells {
 public:
  /// Thread safe.
  void add(const std::vector<int>& slots) {
    const std::lock_guard lock(mutex_);
    slots_.insert(slots_.end(), slots.begin(), slots.end());
  }
  void teach(const RadianceCacheBlendJob& job) {
    std::ranges::sort(slots_);
    const shared::RadianceCacheConstants& c = job.constants;
    const CellScale scale{job.frame.eye, c.cell_angle, c.least_size};
    for (const int slot : slots_) learn(job.guide.data, scale, job.cells[slot], c.frame_number);
  }

 private:
  std::mutex mutex_;
  std::vector<int> slots_;
};

}  // namespace

void radiance_cache_blend(const RadianceCacheBlendJob& job) {
  const shared::RadianceCacheConstants& constants = job.constants;
  LearntCells learnt;
  for_each_range(shared::cache_cells, slots_of_thread, [&](int first, int last) {
    std::vector<int> gathered;
    for (int i = first; i < last; ++i) {
      shared::RadianceCell& cell = job.cells[i];
      if (job.keys[i] == 0) continue;
      if (cell.state == shared::cell_blocked) split(cell);
      if (cell.state != shared::cell_updated) continue;
      cell.samples = std::min(cell.samples + 1, constants.most_samples);
      const float later = 2.0f / static_cast<float>(cell.samples + 1);
      const float weight = std::min(std::max(later, constants.least_weight), 1.0f);
      cell.direct = glm::mix(cell.direct, cell.new_direct, weight);
      if (cell.new_indirect.x < 0.0f) continue;
      cell.indirect = glm::mix(cell.indirect, cell.new_indirect, weight);
      gathered.push_back(i);
    }
    if (constants.guided != 0) learnt.add(gathered);
  });
  learnt.teach(job);
  *job.report.data =
      job.keys[shared::cache_counts + constants.frame_number % shared::cache_counters];
  const std::uint32_t next = (constants.frame_number + 1) % shared::cache_counters;
  job.keys[shared::cache_counts + next] = job.keys[shared::cache_used_counts + next] = 0;
}

}  // namespace heliograph::render::kernels
