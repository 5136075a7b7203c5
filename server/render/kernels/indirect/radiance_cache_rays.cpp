#include "render/kernels/indirect/path_guide.hpp"
#include "render/kernels/indirect/radiance_cache.hpp"
#include "render/kernels/simd/rows.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/indirect/radiance_cache_rays.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/simd/emissive_choice.hpp"
#include "render/kernels/simd/gathering_rays.hpp"
#include "render/kernels/simd/light_grid.hpp"
#include "render/kernels/simd/radiance_cache.hpp"
#include "render/kernels/simd/random.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// Three hashed words of a cell in this frame, as numbers in [0, 1).
class CellNumbers : RandomDigits<UnsignedTag> {
 public:
  CellNumbers(std::uint32_t frame_number, std::uint32_t seed)
      : RandomDigits(unsigned_tag), frame_number_(frame_number), seed_(seed) {}

  glm::vec2 at(std::uint32_t check, std::uint32_t which) const {
    const glm::uvec3 hashed = pcg3d({check, frame_number_, seed_ * 16u + which});
    return glm::vec2(hashed.x >> 8u, hashed.y >> 8u) * 0x1p-24f;
  }

 private:
  std::uint32_t frame_number_;
  std::uint32_t seed_;
};

/// White surfaces without specular lobes.
HWY_INLINE SurfaceMaterial<Float> white_surface(const Float3& normal) {
  SurfaceMaterial<Float> m;
  m.normal = m.geometric = m.eye = normal;
  m.n_dot_v = m.roughness = one();
  m.f0 = m.f90_minus_f0 = m.specular_albedo = numbers(0.0f);
  m.diffuse_albedo = numbers(1.0f);
  return m;
}

/// Some slots of the cache.
class CellUpdates {
 public:
  CellUpdates(const RadianceCacheRaysJob& job)
      : job_(job), numbers_(job.constants.frame_number, job.frame.seed) {}

  /// Cells from `first` to before `last`, whose rays fit into a batch.
  HWY_INLINE void generate(int first, int last) {
    for (int i = first; i < last; ++i) {
      if (is_due(static_cast<std::uint32_t>(i))) due_[count_++] = i;
    }
    RayBatch rays, shadows;
    for (std::size_t i = 0; i < count_; i += hn::Lanes(tag)) add_rays(i, rays, shadows);
    rays.append_to(job_.rays);
    job_.rays.append({probes_.data(), probe_count_});
    shadows.append_to(job_.shadows);
  }
  CellCounts counts() const { return counts_; }

 private:
  bool is_due(std::uint32_t slot) {
    const shared::RadianceCacheConstants& c = job_.constants;
    std::uint32_t& key = job_.keys[slot];
    if (c.reset != 0) key = 0;
    if (key == 0) return false;
    shared::RadianceCell& cell = job_.cells[slot];
    cell.priority = 0;
    const std::uint32_t idle = c.frame_number - cell.last_used;
    const std::uint32_t before = (c.frame_number + 2) % shared::cache_counters;
    const bool crowded = job_.keys[shared::cache_counts + before] > shared::cache_crowd;
    if (idle > (crowded ? shared::cache_crowd_lifetime : shared::cache_lifetime)) {
      key = 0;
      return false;
    }
    ++counts_.alive;
    if (cell.state == shared::cell_split) return false;
    cell.state = shared::cell_rests;
    if (c.forget != 0) forget(cell, idle);
    if (idle > shared::cache_used_frames) return false;
    ++counts_.used;
    const std::uint32_t used = job_.keys[shared::cache_used_counts + before];
    const float share = c.updates / static_cast<float>(std::max(used, 1u));
    const bool is_new = cell.samples < shared::cache_new_samples;
    const float probability = is_new ? share * shared::cache_new_factor : share;
    if (numbers_.at(key, 0).x >= probability) return false;
    cell.state = shared::cell_updated;
    cell.new_direct = cell.new_indirect = glm::vec3(0.0f);
    if (cell.moved != 0 && cell.splits < shared::most_splits) add_probe(slot);
    return true;
  }

  /// Light changes: few samples remain, or none where nothing is about to update them.
  static void forget(shared::RadianceCell& cell, std::uint32_t idle) {
    const std::uint32_t most = idle > shared::cache_used_frames ? 0 : shared::cache_new_samples;
    cell.samples = std::min(cell.samples, most);
  }

  void add_probe(std::uint32_t slot) {
    shared::RadianceCell& cell = job_.cells[slot];
    cell.moved = 0;
    const glm::vec3 end = cell.position + cell.normal * (shared::cell_lift * cell.size);
    const float distance = glm::distance(cell.anchor, end);
    if (!(distance > 0.0f)) return;
    probes_[probe_count_++] = {.origin = cell.anchor,
                               .t_min = 0.0f,
                               .direction = (end - cell.anchor) / distance,
                               .t_max = distance,
                               .pixel = slot,
                               .user = shared::probe_mark,
                               .padding0 = 0,
                               .padding1 = 0};
  }

  GuidedPair guided(const shared::RadianceCell& cell, const glm::vec2& u) const {
    const shared::RadianceCacheConstants& c = job_.constants;
    if (c.guided == 0) return unguided_pair(u);
    return guided_pair(job_.guide.data, {job_.frame.eye, c.cell_angle, c.least_size}, cell.position,
                       cell.normal, u);
  }

  HWY_INLINE void add_rays(std::size_t at, RayBatch& rays, RayBatch& shadows) const {
    const std::size_t count = std::min(count_ - at, hn::Lanes(tag));
    StoredTriples positions, normals;
    HWY_ALIGN std::array<float, hn::MaxLanes(Tag())> pick{}, entry_picks{}, u{}, v{}, weights{},
        across{}, down{};
    HWY_ALIGN std::array<int, hn::MaxLanes(Tag())> slots{};
    for (std::size_t lane = 0; lane < hn::Lanes(tag); ++lane) {
      const int slot = due_[at + std::min(lane, count - 1)];
      shared::RadianceCell& cell = job_.cells[slot];
      const std::uint32_t check = job_.keys[slot];
      slots[lane] = slot;
      positions.put(lane, cell.position);
      normals.put(lane, cell.normal);
      const GuidedPair direction = guided(cell, numbers_.at(check, 1));
      cell.bin = direction.bin;
      u[lane] = direction.u.x, v[lane] = direction.u.y, weights[lane] = direction.weight;
      const glm::vec2 point = numbers_.at(check, 3);
      const glm::vec2 picks = numbers_.at(check, 2);
      pick[lane] = picks.x, entry_picks[lane] = picks.y;
      across[lane] = point.x, down[lane] = point.y;
    }
    const auto load = [](const auto& values) HWY_ATTR { return hn::Load(tag, values.data()); };
    const Mask requested = hn::FirstN(tag, count);
    const Float3 position = positions.load(), normal = normals.load();
    RayLanes ray;
    ray.origin = offset_origin(position, normal, zero());
    ray.direction = sample_cosine_by_axis(normal, load(u), load(v));
    ray.t_min = zero();
    ray.t_max = number(1e30f);
    ray.pixel = hn::Load(integer_tag, slots.data());
    ray.user = {zero(), load(weights), cosine_density(dot(ray.direction, normal))};
    rays.add(ray, requested);
    const Receivers receivers{
        position, normal, load(pick), load(entry_picks), {load(across), load(down)}, requested};
    if (!job_.samples_emissive) {
      const LightRays light = light_rays(ray, receivers);
      return shadows.add(light.ray, light.valid);
    }
    add_light_or_emissive(at, ray, receivers, shadows);
  }

  struct Receivers {
    Float3 position, normal;
    Float pick, entry_picks;
    Float2 point;
    Mask requested;
  };
  /// Rays that carry what arrives if nothing is in their way, and its luminance.
  struct LightRays {
    RayLanes ray;
    Float total;
    Mask valid;
  };

  /// `ray`: origins, and which cells they belong to.
  HWY_INLINE LightRays light_rays(const RayLanes& ray, const Receivers& at) const {
    LightRays made{ray, zero(), hn::Gt(zero(), zero())};
    if ((job_.frame.flags & shared::frame_direct) == 0) return made;
    const SurfaceMaterial<Float> m = white_surface(at.normal);
    Float pick = at.pick;
    const LightChoice light = choose_light(job_.lights, job_.tables.ltc, m, at.position,
                                           at.requested, at.entry_picks, pick);
    made.valid = aim(job_.lights.all, job_.lights.outside, light, m, at.position, at.point, pick,
                     at.requested, made.ray);
    if ((job_.frame.flags & shared::frame_shadows) == 0) made.ray.t_max = zero();
    made.ray.user = light.contribution * (light.total / light.weight);
    made.total = light.total;
    return made;
  }

  /// One of both, in proportion to their light. `first`: of the cells that are due.
  HWY_INLINE void add_light_or_emissive(std::size_t first, const RayLanes& ray, const Receivers& at,
                                        RayBatch& shadows) const {
    HWY_ALIGN std::array<float, hn::MaxLanes(Tag())> start{}, pick{}, which{};
    for (std::size_t lane = 0; lane < hn::Lanes(tag); ++lane) {
      const std::uint32_t check = job_.keys[due_[std::min(first + lane, count_ - 1)]];
      const glm::vec2 numbers = numbers_.at(check, 8);
      start[lane] = numbers.x, pick[lane] = numbers.y;
      which[lane] = numbers_.at(check, 9).x;
    }
    const LightRays light = light_rays(ray, at);
    const EmissiveChoice emissive =
        choose_emissive(job_.points, at.position, at.normal, at.normal, hn::Load(tag, start.data()),
                        hn::Load(tag, pick.data()));
    const Float both = light.total + emissive.total;
    const Mask shines =
        hn::And(at.requested, hn::Lt(hn::Load(tag, which.data()) * both, emissive.total));
    RayLanes made = light.ray;
    made.direction = select(shines, emissive.direction, made.direction);
    made.t_max = select(shines, emissive.distance * number(0.999f), made.t_max);
    const Float total = select(shines, emissive.total, light.total);
    made.user = select(shines, emissive.light, made.user) *
                (both / select(hn::Gt(total, zero()), total, one()));
    const Integer mark = integer(static_cast<int>(shared::cache_emissive_ray));
    made.pixel = hn::Or(made.pixel, hn::IfThenElseZero(integer_mask(shines), mark));
    shadows.add(made, hn::Or(shines, hn::AndNot(shines, light.valid)));
  }

  const RadianceCacheRaysJob& job_;
  CellNumbers numbers_;
  std::array<int, ray_batch> due_;
  std::size_t count_ = 0;
  std::array<shared::Ray, ray_batch> probes_;
  std::size_t probe_count_ = 0;
  CellCounts counts_;
};

CellCounts cell_batch(const RadianceCacheRaysJob& job, int first, int last) {
  CellUpdates updates(job);
  updates.generate(first, last);
  return updates.counts();
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(cell_batch);

void radiance_cache_rays(const RadianceCacheRaysJob& job) {
  std::atomic<std::uint32_t> alive = 0, used = 0;
  for_each_batch(shared::cache_cells, [&](int first, int last) {
    const CellCounts counts = HWY_DYNAMIC_DISPATCH(cell_batch)(job, first, last);
    alive += counts.alive;
    used += counts.used;
  });
  const std::uint32_t now = job.constants.frame_number % shared::cache_counters;
  job.keys[shared::cache_counts + now] = alive;
  job.keys[shared::cache_used_counts + now] = used;
  job.rays.end();
  job.shadows.end();
}

}  // namespace heliograph::render::kernels
#endif
