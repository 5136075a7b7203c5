#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/rays/ray_index.glsl"
layout(local_size_x = 64) in;
// What the cells' gathering rays bring. Cells see each other: light bounces once more every frame.
#define TEXTURE_ONE_LEVEL
#include "lib/denoise/moments.glsl"
#include "shared/radiance_cache.h"

layout(set = 1, binding = 0, std430) readonly buffer Count { RayCount ray_count; };
layout(set = 1, binding = 1, std430) readonly buffer Rays { Ray rays[]; };
layout(set = 1, binding = 2, std430) readonly buffer Hits { Hit hits[]; };
layout(set = 1, binding = 3, std430) buffer Keys { uint cache_keys[]; };
layout(set = 1, binding = 4, std430) buffer Cells { RadianceCell cells[]; };
layout(push_constant) uniform Constants { RadianceCacheConstants constants; };
#include "lib/lighting/gathered_light.glsl"

/// A probe that meets nothing has reached the cell's new place.
void end_probe(Ray ray, Hit hit) {
  cells[ray.pixel].anchor = ray.origin + ray.direction * ray.t_max;
  if (hit.instance == hit_none) return;
  HitSurface s = hit_surface(hit, ray.direction, 0.0);
  cells[ray.pixel].anchor = s.position;
  cells[ray.pixel].new_direct = s.geometric;
  cells[ray.pixel].state = cell_blocked;
}

void main() {
  uint index = ray_index();
  if (index >= ray_count.count) return;
  Ray ray = rays[index];
  if (ray.user == probe_mark) {
    end_probe(ray, hits[index]);
    return;
  }
  bool known;
  vec3 light = sanitize(gathered_light(ray, hits[index], constants, known));
  cells[ray.pixel].gathered = known ? luminance(light) : nothing_gathered;
  cells[ray.pixel].new_indirect =
      known ? light * uintBitsToFloat(ray.padding0) : vec3(nothing_gathered);
}
