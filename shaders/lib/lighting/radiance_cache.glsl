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

/// Binary logarithm of the edge length of cells at `position`, as far as the eye is concerned.
int cell_level(vec3 position, RadianceCacheConstants c) {
  float size = distance(position, frame.eye.xyz) * c.cell_angle;
  return int(ceil(log2(max(size, c.least_size))));
}

/// The same for a ray of length `t`, metres: a short one sees little of a large cell.
int cell_level_of_ray(float t, RadianceCacheConstants c) {
  return int(ceil(log2(max(t * c.cell_fraction, c.least_size))));
}

/// 0 to 5: the axis that a normal follows most.
uint normal_axis(vec3 n) {
  vec3 a = abs(n);
  if (a.x >= a.y && a.x >= a.z) return n.x >= 0.0 ? 0u : 1u;
  if (a.y >= a.z) return n.y >= 0.0 ? 2u : 3u;
  return n.z >= 0.0 ? 4u : 5u;
}

CellKey cell_key(vec3 position, vec3 normal, int level) {
  ivec3 cell = ivec3(floor(position * exp2(float(-level))));
  uvec3 hashed = pcg3d(uvec3(cell));
  hashed = pcg3d(hashed + uvec3(uint(level + 64) * 8u + normal_axis(normal), 0u, 0u));
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
uint touch_cell(vec3 position, vec3 normal, int level, uint frame_number) {
  CellKey key = cell_key(position, normal, level);
  uint slot = find_cell(key);
  for (uint i = 0u; i < cache_bucket && slot == no_cell; ++i) {
    uint at = key.first + i;
    uint before = atomicCompSwap(cache_keys[at], 0u, key.check);
    if (before == 0u) {
      cells[at].position = position;
      cells[at].normal = normal;
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
  int coarse = cell_level(position, c);
  int level = clamp(cell_level_of_ray(t, c), coarse - finer_levels, coarse);
  for (uint i = 0u; i < 2u; ++i) {
    uint slot = touch_cell(position, normal, level, c.frame_number);
    if (slot != no_cell && cells[slot].samples > 0u) {
      return CachedLight(cells[slot].direct, cells[slot].indirect, true);
    }
    if (level == coarse) break;
    level = coarse;
  }
  return CachedLight(vec3(0.0), vec3(0.0), false);
}

/// What a surface sends to the eye of indirect light: `irradiance` / pi. Its specular lobes show the
/// environment as far as the irradiance allows, and of the rest what comes from everywhere. `open`:
/// the irradiance / pi of the environment alone, if nothing hid it.
vec3 reflected_light(SurfaceMaterial m, vec3 irradiance, vec3 open) {
  float sky = luminance(open);
  float visible = sky > 0.0 ? min(luminance(irradiance) / sky, 1.0) : 0.0;
  vec3 specular = m.specular_albedo * irradiance;
  if (enabled(frame_environment_specular)) {
    specular = m.specular_albedo * max(irradiance - visible * open, vec3(0.0)) +
               visible * environment_specular(m);
  }
  return wide_albedo(m) * irradiance + specular;
}

#endif
