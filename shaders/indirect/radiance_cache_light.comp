#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/rays/ray_index.glsl"
layout(local_size_x = 64) in;
// The light of cells' shadow rays that are not occluded. That of emissive triangles belongs to
// indirect light, whose other part gathering rays have brought.
#include "lib/denoise/moments.glsl"
#include "shared/radiance_cache.h"

layout(set = 1, binding = 0, std430) readonly buffer Count { RayCount ray_count; };
layout(set = 1, binding = 1, std430) readonly buffer Rays { Ray rays[]; };
layout(set = 1, binding = 2, std430) readonly buffer Occluded { uint occluded[]; };
layout(set = 1, binding = 3, std430) buffer Cells { RadianceCell cells[]; };

void main() {
  uint index = ray_index();
  if (index >= ray_count.count || occluded[index] != 0u) return;
  Ray ray = rays[index];
  vec3 light = sanitize(uintBitsToFloat(uvec3(ray.user, ray.padding0, ray.padding1)));
  uint slot = ray.pixel % cache_cells;
  if (cells[slot].state != cell_updated) return;
  if (ray.pixel == slot) {
    cells[slot].new_direct = light;
  } else if (cells[slot].new_indirect.x >= 0.0) {
    cells[slot].new_indirect += light;
  }
}
