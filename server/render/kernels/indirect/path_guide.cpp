#include "render/kernels/indirect/path_guide.hpp"

#include <array>
#include <numeric>

#include "render/kernels/common/parallel.hpp"

namespace heliograph::render::kernels {
namespace {

using shared::guide_bins;

constexpr std::uint32_t no_guide = ~0u;
constexpr int entries_of_thread = 512;
constexpr float below_one = 1.0f - 0x1p-24f;

struct GuideKey {
  std::uint32_t first;  // slot of its bucket
  std::uint32_t check;
};

GuideKey guide_key(const CellScale& scale, const glm::vec3& position, const glm::vec3& normal) {
  const int level = scale.level_at(position) + shared::guide_coarser;
  const glm::vec3 place = glm::floor(position * std::ldexp(1.0f, -level));
  glm::uvec3 hashed = pcg3d(glm::uvec3(glm::ivec3(place)));
  hashed.x += static_cast<std::uint32_t>(level + 64) * 8u + normal_axis(normal);
  hashed = pcg3d(hashed);
  constexpr std::uint32_t buckets = shared::guide_entries / shared::guide_bucket;
  return {hashed.x % buckets * shared::guide_bucket, std::max(hashed.y, 1u)};
}

std::uint32_t find(const shared::GuideEntry* guide, std::uint32_t first, std::uint32_t check) {
  for (std::uint32_t i = first; i < first + shared::guide_bucket; ++i) {
    if (guide[i].check == check) return i;
  }
  return no_guide;
}

std::uint32_t limit_of(const glm::uvec4& limits, std::uint32_t bin) {
  if (bin == guide_bins) return shared::guide_whole;
  return limits[static_cast<int>(bin >> 2u)] >> (8u * (bin & 3u)) & 0xffu;
}

void set_limit(glm::uvec4& limits, std::uint32_t bin, std::uint32_t limit) {
  limits[static_cast<int>(bin >> 2u)] |= limit << (8u * (bin & 3u));
}

/// Of an entry that has learnt nothing.
glm::uvec4 even_limits() {
  glm::uvec4 limits(0u);
  for (std::uint32_t i = 0; i < guide_bins; ++i) {
    set_limit(limits, i, i * (shared::guide_whole / guide_bins));
  }
  return limits;
}

void write_limits(shared::GuideEntry& entry) {
  const float count = std::accumulate(entry.counts, entry.counts + guide_bins, 0.0f);
  const float squares = std::accumulate(entry.squares, entry.squares + guide_bins, 0.0f);
  const float mean = squares / std::max(count, 1.0f);
  std::array<float, guide_bins> roots;
  for (std::uint32_t i = 0; i < guide_bins; ++i) {
    roots[i] = std::sqrt((entry.squares[i] + mean) / (entry.counts[i] + 1.0f));
  }
  const float sum = std::accumulate(roots.begin(), roots.end(), 0.0f);
  constexpr auto shared_out =
      static_cast<float>(shared::guide_whole - guide_bins * shared::guide_least);
  entry.limits = glm::uvec4(0u);
  float before = 0.0f;
  for (std::uint32_t i = 0; i < guide_bins; ++i) {
    const float part = sum > 0.0f ? before / sum : static_cast<float>(i) / guide_bins;
    set_limit(entry.limits, i,
              i * shared::guide_least + static_cast<std::uint32_t>(shared_out * part + 0.5f));
    before += roots[i];
  }
}

void update(shared::GuideEntry& entry, const shared::RadianceCacheConstants& c) {
  if (c.frame_number - entry.last_used > shared::guide_lifetime) {
    entry = {};
    return;
  }
  const float count = std::accumulate(entry.counts, entry.counts + guide_bins, 0.0f);
  float kept = count > shared::guide_memory ? 0.5f : 1.0f;
  if (c.forget != 0) kept = std::min(kept, shared::guide_memory_of_change / std::max(count, 1.0f));
  for (std::uint32_t i = 0; i < guide_bins; ++i) {
    entry.counts[i] *= kept;
    entry.squares[i] *= kept;
  }
  write_limits(entry);
}

}  // namespace

GuidedPair unguided_pair(const glm::vec2& u) {
  const glm::uvec2 bins(shared::guide_rings, shared::guide_sectors);
  const glm::uvec2 at = glm::min(glm::uvec2(u * glm::vec2(bins)), bins - 1u);
  return {u, at.x * shared::guide_sectors + at.y, 1.0f};
}

GuidedPair guided_pair(const shared::GuideEntry* guide, const CellScale& scale,
                       const glm::vec3& position, const glm::vec3& normal, const glm::vec2& u) {
  const GuideKey key = guide_key(scale, position, normal);
  const std::uint32_t slot = find(guide, key.first, key.check);
  if (slot == no_guide) return unguided_pair(u);
  const glm::uvec4& limits = guide[slot].limits;
  const float at = u.x * static_cast<float>(shared::guide_whole);
  std::uint32_t bin = 0;
  for (std::uint32_t bit = guide_bins / 2; bit > 0; bit /= 2) {
    if (static_cast<float>(limit_of(limits, bin + bit)) <= at) bin += bit;
  }
  const auto first = static_cast<float>(limit_of(limits, bin));
  const float share = static_cast<float>(limit_of(limits, bin + 1)) - first;
  const glm::vec2 within(std::min((at - first) / share, below_one), u.y);
  const glm::vec2 corner(bin / shared::guide_sectors, bin % shared::guide_sectors);
  const glm::vec2 bins(shared::guide_rings, shared::guide_sectors);
  return {glm::min((corner + within) / bins, glm::vec2(below_one)), bin,
          static_cast<float>(shared::guide_whole) / (static_cast<float>(guide_bins) * share)};
}

void learn(shared::GuideEntry* guide, const CellScale& scale, const shared::RadianceCell& cell,
           std::uint32_t frame_number) {
  const GuideKey key = guide_key(scale, cell.position, cell.normal);
  std::uint32_t slot = find(guide, key.first, key.check);
  if (slot == no_guide) {
    slot = find(guide, key.first, 0);
    if (slot == no_guide) return;
    guide[slot] = {};
    guide[slot].check = key.check;
    guide[slot].limits = even_limits();
  }
  shared::GuideEntry& entry = guide[slot];
  entry.last_used = frame_number;
  entry.counts[cell.bin] += 1.0f;
  entry.squares[cell.bin] += cell.gathered * cell.gathered;
}

void path_guide(const PathGuideJob& job) {
  for_each_range(shared::guide_entries, entries_of_thread, [&](int first, int last) {
    for (int i = first; i < last; ++i) {
      shared::GuideEntry& entry = job.guide[i];
      if (job.constants.reset != 0) entry = {};
      if (entry.check != 0) update(entry, job.constants);
    }
  });
}

}  // namespace heliograph::render::kernels
