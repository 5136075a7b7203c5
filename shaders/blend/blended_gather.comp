#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/rays/ray_index.glsl"
layout(local_size_x = 64) in;
// Adds indirect light to blended surfaces: what the ray of each pixel has gathered, times the weight
// that it carries.
#define TEXTURE_ONE_LEVEL
#include "lib/denoise/moments.glsl"
#include "shared/radiance_cache.h"

layout(set = 1, binding = 0, std430) readonly buffer Count { RayCount ray_count; };
layout(set = 1, binding = 1, std430) readonly buffer Rays { Ray rays[]; };
layout(set = 1, binding = 2, std430) readonly buffer Hits { Hit hits[]; };
layout(set = 1, binding = 3, std430) buffer Keys { uint cache_keys[]; };
layout(set = 1, binding = 4, std430) buffer Cells { RadianceCell cells[]; };
layout(set = 1, binding = 5, rgba32f) uniform image2D radiance;
layout(push_constant) uniform Constants { RadianceCacheConstants constants; };
#include "lib/lighting/gathered_light.glsl"

/// All emission belongs to the ray: nothing else brings that of emissive triangles.
const float gathered_alone = 1e30;

void main() {
  uint index = ray_index();
  if (index >= ray_count.count) return;
  Ray ray = rays[index];
  vec3 weight = uintBitsToFloat(uvec3(ray.user, ray.padding0, ray.padding1));
  ray.padding1 = floatBitsToUint(gathered_alone);
  bool known;
  vec3 light = gathered_light(ray, hits[index], constants, known);
  if (!known) light = unknown_openness * environment_irradiance(ray.direction);
  ivec2 pixel = ivec2(ray.pixel & 0xffffu, ray.pixel >> 16u);
  vec4 sum = imageLoad(radiance, pixel);
  imageStore(radiance, pixel, vec4(sum.rgb + sanitize(weight * light), sum.a));
}
