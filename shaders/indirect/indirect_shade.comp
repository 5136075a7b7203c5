#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/rays/ray_index.glsl"
layout(local_size_x = 64) in;
// What gathering rays bring: the environment, or what the surface that they hit sends on of the
// light in the radiance cache.
#define TEXTURE_ONE_LEVEL
#include "lib/denoise/moments.glsl"
#include "lib/lighting/two_sided_light.glsl"
#include "shared/radiance_cache.h"

layout(set = 1, binding = 0, std430) readonly buffer Count { RayCount ray_count; };
layout(set = 1, binding = 1, std430) readonly buffer Rays { Ray rays[]; };
layout(set = 1, binding = 2, std430) readonly buffer Hits { Hit hits[]; };
layout(set = 1, binding = 3, std430) buffer Keys { uint cache_keys[]; };
layout(set = 1, binding = 4, std430) buffer Cells { RadianceCell cells[]; };
layout(set = 1, binding = 5, rgba32f) writeonly uniform image2D radiance;
layout(push_constant) uniform Constants { RadianceCacheConstants constants; };
#include "lib/lighting/gathered_light.glsl"

void main() {
  uint index = ray_index();
  if (index >= ray_count.count) return;
  Ray ray = rays[index];
  bool known;
  vec3 light = gathered_light(ray, hits[index], constants, known);
  if (scene_has(scene_diffuse_transmits) && ray.user != 0u) light *= unpack_side_share(ray.user);
  ivec2 pixel = ivec2(ray.pixel & 0xffffu, ray.pixel >> 16u);
  imageStore(radiance, pixel,
             known ? vec4(sanitize(light) * uintBitsToFloat(ray.padding0), 1.0)
                   : vec4(0.0, 0.0, 0.0, -1.0));
}
