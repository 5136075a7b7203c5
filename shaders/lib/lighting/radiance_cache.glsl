// Finding cells of the radiance cache. A pass declares `CACHE_ACCESS` buffers before it includes
// this: `cache_keys` and `cells`.
#ifndef HELIOGRAPH_RADIANCE_CACHE_GLSL
#define HELIOGRAPH_RADIANCE_CACHE_GLSL
#include "lib/frame.glsl"
#include "lib/lighting/cell_level.glsl"
#include "lib/lighting/environment.glsl"
#include "lib/lighting/lights.glsl"
#include "lib/math/random.glsl"
#include "shared/radiance_cache.h"

const uint no_cell = 0xffffffffu;

struct CellKey {
  uint first;  // slot of its bucket
  uint check;
};

/// Binary logarithm of the edge length of cells that a ray of length `t`, metres, asks for: a short
/// one sees little of a large cell.
int cell_level_of_ray(float t, RadianceCacheConstants c) {
  return int(ceil(log2(max(t * c.cell_fraction, c.least_size))));
}

/// Where a ray has met a surface.
struct SeenPlace {
  vec3 position;  // world
  vec3 normal;    // geometric, world, on the side that the ray has come from
  bool is_back;   // of the triangle
};

CellKey cell_key(SeenPlace at, int level) {
  ivec3 cell = ivec3(floor(at.position * exp2(float(-level))));
  uvec3 hashed = pcg3d(uvec3(cell));
  uint side = normal_axis(at.normal) + (at.is_back ? 6u : 0u);
  hashed = pcg3d(hashed + uvec3(uint(level + 64) * 16u + side, 0u, 0u));
  return CellKey((hashed.x % (cache_cells / cache_bucket)) * cache_bucket, max(hashed.y, 1u));
}

/// Of a half of a split cell.
CellKey half_key(CellKey whole, bool in_front) {
  uvec3 hashed = pcg3d(uvec3(whole.first, whole.check, in_front ? 1u : 2u));
  return CellKey((hashed.x % (cache_cells / cache_bucket)) * cache_bucket, max(hashed.y, 1u));
}

vec3 raised(vec3 position, vec3 normal, float size) {
  return position + normal * (cell_lift * size);
}

uint find_cell(CellKey key) {
  for (uint i = 0u; i < cache_bucket; ++i) {
    if (cache_keys[key.first + i] == key.check) return key.first + i;
  }
  return no_cell;
}

/// The key of the part of a split cell that has the place; of whole cells their own.
CellKey part_key(SeenPlace at, int level, uint frame_number, out uint splits) {
  CellKey key = cell_key(at, level);
  vec3 place = raised(at.position, at.normal, exp2(float(level)));
  for (splits = 0u; splits < most_splits; ++splits) {
    uint slot = find_cell(key);
    if (slot == no_cell || cells[slot].state != cell_split) break;
    cells[slot].last_used = frame_number;
    key = half_key(key, dot(place - cells[slot].position, cells[slot].normal) > 0.0);
  }
  return key;
}

/// Finds a cell or makes it, if there is a free slot. Which place of a cell is updated changes: a
/// random one of those that are asked for, so that its mean is theirs.
uint touch_cell(SeenPlace at, int level, uint frame_number) {
  uint splits;
  CellKey key = part_key(at, level, frame_number, splits);
  uint slot = find_cell(key);
  for (uint i = 0u; i < cache_bucket && slot == no_cell; ++i) {
    uint free = key.first + i;
    uint before = atomicCompSwap(cache_keys[free], 0u, key.check);
    if (before == 0u) {
      float size = exp2(float(level));
      cells[free].position = at.position;
      cells[free].normal = at.normal;
      cells[free].size = size;
      cells[free].splits = splits;
      cells[free].anchor = raised(at.position, at.normal, size);
      cells[free].moved = 0u;
    }
    if (before == 0u || before == key.check) slot = free;
  }
  if (slot == no_cell) return slot;
  cells[slot].last_used = frame_number;
  uvec3 random = pcg3d(floatBitsToUint(at.position) + frame_number);
  if (random.x % moves_every == 0u && atomicMax(cells[slot].priority, random.y) < random.y) {
    cells[slot].position = at.position;
    cells[slot].normal = at.normal;
    cells[slot].moved = 1u;
  }
  return slot;
}

/// Irradiance / pi.
struct CachedLight {
  vec3 direct;
  vec3 indirect;
  float size;  // edge length of the cell, metres
  bool known;
};

/// `t`: length of the ray that asks, metres.
CachedLight cached_light(SeenPlace at, float t, RadianceCacheConstants c) {
  int coarse = cell_level(at.position, c.cell_angle, c.least_size);
  int level = clamp(cell_level_of_ray(t, c), coarse - finer_levels, coarse);
  for (uint i = 0u; i < 2u; ++i) {
    uint slot = touch_cell(at, level, c.frame_number);
    if (slot != no_cell && cells[slot].samples > 0u) {
      return CachedLight(cells[slot].direct, cells[slot].indirect, exp2(float(level)), true);
    }
    if (level == coarse) break;
    level = coarse;
  }
  return CachedLight(vec3(0.0), vec3(0.0), 0.0, false);
}

/// The place on the other side of the triangle.
SeenPlace behind_place(SeenPlace at) { return SeenPlace(at.position, -at.normal, !at.is_back); }

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
