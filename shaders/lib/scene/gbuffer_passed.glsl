// The G-buffer behind what the camera's rays have passed first: each is traced on until its surface
// is stored, all in one invocation. The few rays that come so far would wait for every other pass.
#define ANY_HIT false
#define BVH_BINDING 14
#include "lib/rays/bvh.glsl"
#include "lib/rays/ray_index.glsl"
#include "lib/scene/gbuffer_hits.glsl"

layout(set = 1, binding = 0, std430) readonly buffer Count { RayCount ray_count; };
layout(set = 1, binding = 1, std430) readonly buffer Rays { Ray rays[]; };
layout(push_constant) uniform Constants {
  uint root;    // of the hierarchy
  uint rounds;  // how many surfaces are tried: the last is taken as it is
};

void main() {
  uint index = traced_ray(ray_count.count);
  if (index == not_traced) return;
  Ray ray = rays[index];
  ivec2 pixel = pixel_of(ray);
  for (uint rounds_left = rounds; rounds_left > 0u; --rounds_left) {
    Hit hit = trace(ray, root, ray_count.blending);
    if (hit.instance == hit_none) {
      store_nothing(pixel);
      return;
    }
    HitSurface s = met_surface(ray, hit);
    if (rounds_left == 1u || !passes(ray, s)) {
      store(pixel, hit, s);
      return;
    }
    ray = beyond(ray, hit);
  }
}
