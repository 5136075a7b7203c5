#pragma once

#include <mutex>
#include <span>
#include <vector>

#include "render/kernels/common/frame_job.hpp"
#include "render/kernels/common/ray_sink.hpp"
#include "render/kernels/common/tile.hpp"
#include "render/resources/host_tables.hpp"
#include "render/resources/lights/light_grid.hpp"
#include "shaders/shared/emissive.h"
#include "shaders/shared/path_guide.h"
#include "shaders/shared/radiance_cache.h"

/// The radiance cache on all processors: shaders/lib/lighting/radiance_cache.glsl and the passes
/// that update it.
namespace heliograph::render::kernels {

/// A cell that a ray has asked for: made if there is none, or moved to the place of the ray's hit.
struct CacheTouch {
  std::uint32_t priority;  // random: of several places the one with the highest
  std::uint32_t order;     // of the ray, so that the outcome does not depend on threads
  std::uint32_t first;     // slot of its bucket
  std::uint32_t check;
  std::uint32_t splits;
  float size;  // metres
  glm::vec3 position;
  glm::vec3 normal;
};

/// Where a ray has met a surface.
struct SeenPlace {
  glm::vec3 position;  // world
  glm::vec3 normal;    // geometric, world, on the side that the ray has come from
  bool is_back;        // of the triangle
};

/// How many rays ask together, at most.
inline constexpr std::size_t most_cache_queries = 64;

/// A ray of `t` metres that asks for light at its hit.
struct CacheQuery {
  SeenPlace at;
  float t;
  std::uint32_t order;
};

struct CellKey {
  std::uint32_t first;  // slot of its bucket
  std::uint32_t check;
};

/// Irradiance / pi.
struct CachedLight {
  glm::vec3 direct{0.0f};
  glm::vec3 indirect{0.0f};
  float size = 0.0f;  // edge length of the cell, metres; 0: nothing is known
};

/// The cache as a pass of one frame reads it. What the pass asks for and does not find is written
/// down and made after it, in the order of rays.
class CacheReader {
 public:
  CacheReader(std::uint32_t* keys, shared::RadianceCell* cells,
              const shared::RadianceCacheConstants& constants, const glm::vec3& eye)
      : keys_(keys), cells_(cells), constants_(constants), eye_(eye) {}

  /// Light at the hit of every ray. `touches` gets the cells that are to be made or moved. Thread
  /// safe.
  void find(std::span<const CacheQuery> rays, CachedLight* light,
            std::vector<CacheTouch>& touches) const;
  /// Thread safe.
  void add(std::span<const CacheTouch> touches);
  /// After all threads are done.
  void apply();

 private:
  /// The cells that a ray may read: of its own size, and where that knows nothing, the eye's.
  struct Lookup {
    int level, coarse;
    std::uint32_t splits;
    CellKey key;
    std::uint32_t slot;
  };
  Lookup begin(const CacheQuery& ray) const;
  void look_at(const CacheQuery& ray, int level, Lookup& lookup) const;
  void follow_splits(const CacheQuery& ray, Lookup& lookup) const;
  void touch(const CacheQuery& ray, const Lookup& lookup, std::vector<CacheTouch>& touches) const;
  CachedLight read(const CacheQuery& ray, Lookup& lookup, std::vector<CacheTouch>& touches) const;
  void use(std::uint32_t slot) const;

  std::uint32_t* keys_;
  shared::RadianceCell* cells_;
  shared::RadianceCacheConstants constants_;
  glm::vec3 eye_;
  std::mutex mutex_;
  std::vector<CacheTouch> touches_;
};

/// shaders/indirect/radiance_cache_rays.comp
template <class Stage>
struct RadianceCacheRaysBindings {
  gpu::ReadWriteBuffer<Stage, std::uint32_t> keys;
  gpu::ReadWriteBuffer<Stage, shared::RadianceCell> cells;
  RaySink<Stage> rays;
  RaySink<Stage> shadows;  // toward lights
  gpu::ReadBuffer<Stage, shared::EmissivePoint> points;
  gpu::ReadBuffer<Stage, shared::GuideEntry> guide;
};
struct RadianceCacheRaysJob : FrameJob<RadianceCacheRaysBindings, shared::RadianceCacheConstants> {
  SceneLights lights;
  LobeTables tables;
  bool samples_emissive;  // whether `points` are those of this frame
};
void radiance_cache_rays(const RadianceCacheRaysJob& job);

/// Cells of which some slots of the cache have so many.
struct CellCounts {
  std::uint32_t alive = 0;
  std::uint32_t used = 0;  // of late: they may be updated
};

/// shaders/indirect/radiance_cache_shade.comp
template <class Stage>
struct RadianceCacheShadeBindings {
  RaySource<Stage> rays;
  gpu::ReadBuffer<Stage, shared::Hit> hits;
  gpu::ReadWriteBuffer<Stage, std::uint32_t> keys;
  gpu::ReadWriteBuffer<Stage, shared::RadianceCell> cells;
};
struct RadianceCacheShadeJob
    : FrameJob<RadianceCacheShadeBindings, shared::RadianceCacheConstants> {
  bool layered;  // materials of the scene have layers
  SceneView scene;
  const Environment& environment;
  LobeTables tables;
};
void radiance_cache_shade(const RadianceCacheShadeJob& job);

/// shaders/indirect/radiance_cache_light.comp
template <class Stage>
struct RadianceCacheLightBindings {
  RaySource<Stage> shadows;
  gpu::ReadBuffer<Stage, std::uint32_t> occluded;
  gpu::ReadWriteBuffer<Stage, shared::RadianceCell> cells;
};
using RadianceCacheLightJob = gpu::HostPass<RadianceCacheLightBindings>;
void radiance_cache_light(const RadianceCacheLightJob& job);

/// shaders/indirect/radiance_cache_blend.comp
template <class Stage>
struct RadianceCacheBlendBindings {
  gpu::ReadWriteBuffer<Stage, std::uint32_t> keys;
  gpu::ReadWriteBuffer<Stage, shared::RadianceCell> cells;
  gpu::WriteBuffer<Stage, std::uint32_t> report;  // how many cells there are
  gpu::ReadWriteBuffer<Stage, shared::GuideEntry> guide;
};
using RadianceCacheBlendJob = FrameJob<RadianceCacheBlendBindings, shared::RadianceCacheConstants>;
void radiance_cache_blend(const RadianceCacheBlendJob& job);

/// shaders/indirect/indirect_rays.comp
template <class Stage>
struct IndirectRaysBindings {
  gpu::Read<Stage> normals;  // rgba32f
  gpu::Read<Stage> motion;   // rgba32f
  RaySink<Stage> rays;
  gpu::Read<Stage> planned;    // r32ui, shaders/shared/sampling.h, or anything
  gpu::Write<Stage> radiance;  // rgba32f; cleared; w < 0 where the plan leaves it out
  gpu::ReadBuffer<Stage, shared::GuideEntry> guide;
  gpu::Read<Stage> base_color, surface, layers;
};
struct IndirectRaysConstants {
  std::uint32_t by_plan;  // 0: every pixel is sampled
  std::uint32_t guided;   // 1: by the path guide
  float cell_angle;       // of the radiance cache
  float least_size;
};
struct IndirectRaysJob : FrameJob<IndirectRaysBindings, IndirectRaysConstants> {
  bool both_sides;  // surfaces of the scene may scatter light to their other side
  LobeTables tables;
  Rows rows;  // whose rays are made
};
void indirect_rays(const IndirectRaysJob& job);

/// shaders/indirect/indirect_shade.comp
template <class Stage>
struct IndirectShadeBindings {
  RaySource<Stage> rays;
  gpu::ReadBuffer<Stage, shared::Hit> hits;
  gpu::ReadWriteBuffer<Stage, std::uint32_t> keys;
  gpu::ReadWriteBuffer<Stage, shared::RadianceCell> cells;
  gpu::Write<Stage> radiance;  // rgba32f
};
struct IndirectShadeJob : FrameJob<IndirectShadeBindings, shared::RadianceCacheConstants> {
  bool layered;  // materials of the scene have layers
  SceneView scene;
  const Environment& environment;
  LobeTables tables;
};
void indirect_shade(const IndirectShadeJob& job);

}  // namespace heliograph::render::kernels
