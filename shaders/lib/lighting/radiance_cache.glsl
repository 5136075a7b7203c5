// Finding cells of the radiance cache. A pass declares `CACHE_ACCESS` buffers before it includes
// this: `cache_keys` and `cells`.
#ifndef HELIOGRAPH_RADIANCE_CACHE_GLSL
#define HELIOGRAPH_RADIANCE_CACHE_GLSL
#include "lib/frame.glsl"
#include "lib/lighting/environment.glsl"
#include "lib/lighting/lights.glsl"
#include "lib/math/random.glsl"
#include "shared/radiance_cache.h"

const uint no_cell = 0xffffffffu;

struct CellKey {
  uint first;  // slot of its bucket
  uint check;
};

/// Edge length of cells at `position`: a power of two. A short ray sees little of a large cell.
float cell_size(vec3 position, float t, RadianceCacheConstants c) {
  float size = min(distance(position, frame.eye.xyz) * c.cell_angle, t * c.cell_fraction);
  size = max(size, c.least_size);
  return exp2(ceil(log2(size)));
}

/// 0 to 5: the axis that a normal follows most.
uint normal_axis(vec3 n) {
  vec3 a = abs(n);
  if (a.x >= a.y && a.x >= a.z) return n.x >= 0.0 ? 0u : 1u;
  if (a.y >= a.z) return n.y >= 0.0 ? 2u : 3u;
  return n.z >= 0.0 ? 4u : 5u;
}

CellKey cell_key(vec3 position, vec3 normal, float size) {
  ivec3 cell = ivec3(floor(position / size));
  uint level = uint(int(round(log2(size))) + 64);
  uvec3 hashed = pcg3d(uvec3(cell));
  hashed = pcg3d(hashed + uvec3(level * 8u + normal_axis(normal), 0u, 0u));
  return CellKey((hashed.x % (cache_cells / cache_bucket)) * cache_bucket, max(hashed.y, 1u));
}

uint find_cell(CellKey key) {
  for (uint i = 0u; i < cache_bucket; ++i) {
    if (cache_keys[key.first + i] == key.check) return key.first + i;
  }
  return no_cell;
}

/// Finds a cell or makes it, if there is a free slot. Which place of a cell is updated changes: a
/// random one of those that are asked for, so that its mean is theirs.
uint touch_cell(vec3 position, vec3 normal, float size, uint frame_number) {
  CellKey key = cell_key(position, normal, size);
  uint slot = find_cell(key);
  for (uint i = 0u; i < cache_bucket && slot == no_cell; ++i) {
    uint at = key.first + i;
    uint before = atomicCompSwap(cache_keys[at], 0u, key.check);
    if (before == 0u) {
      cells[at].position = position;
      cells[at].normal = normal;
      cells[at].samples = 0u;
      cells[at].direct = cells[at].indirect = vec3(0.0);
    }
    if (before == 0u || before == key.check) slot = at;
  }
  if (slot == no_cell) return slot;
  cells[slot].last_used = frame_number;
  uvec3 random = pcg3d(floatBitsToUint(position) + frame_number);
  if (random.x % moves_every == 0u && atomicMax(cells[slot].priority, random.y) < random.y) {
    cells[slot].position = position;
    cells[slot].normal = normal;
  }
  return slot;
}

/// Irradiance / pi.
struct CachedLight {
  vec3 direct;
  vec3 indirect;
  bool known;
};

/// `t`: length of the ray that asks, metres.
CachedLight cached_light(vec3 position, vec3 normal, float t, RadianceCacheConstants c) {
  float size = cell_size(position, t, c);
  for (uint i = 0u; i < 2u; ++i) {
    uint slot = touch_cell(position, normal, size, c.frame_number);
    if (slot != no_cell && cells[slot].samples > 0u) {
      return CachedLight(cells[slot].direct, cells[slot].indirect, true);
    }
    size *= 8.0;
  }
  return CachedLight(vec3(0.0), vec3(0.0), false);
}

/// What a surface sends to the eye of indirect light: `irradiance` / pi. Its specular lobes show the
/// environment as far as that is open, and otherwise what comes from everywhere.
vec3 reflected_light(SurfaceMaterial m, vec3 irradiance) {
  vec3 open = enabled(frame_environment_diffuse) ? environment_irradiance(m.normal) : vec3(0.0);
  float visible = clamp(luminance(irradiance) / max(luminance(open), 1e-6), 0.0, 1.0);
  vec3 specular = m.specular_albedo * irradiance;
  if (enabled(frame_environment_specular)) {
    specular = mix(specular, environment_specular(m), visible);
  }
  return wide_albedo(m) * irradiance + specular;
}

#endif
