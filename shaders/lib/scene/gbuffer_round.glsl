// The G-buffer from camera rays, round by round: the surface that a ray has met is stored, or the
// ray goes on. GBUFFER_FIRST: of all the camera's rays, each made again in place of being read, in
// groups of 8 x 8 invocations; otherwise of a stream of them.
#include "lib/rays/ray_stream.glsl"
#include "lib/scene/gbuffer_hits.glsl"

layout(set = 1, binding = 4, std430) buffer Count { RayCount ray_count; };
layout(set = 1, binding = 5, std430) writeonly buffer Rays { StoredRay rays[]; };

#ifdef GBUFFER_FIRST
#include "lib/rays/gbuffer_ray.glsl"
#ifdef GBUFFER_DRAWN
#define BVH_BINDING 14
#define DRAWN_BINDING 17
#include "lib/rays/drawn_hit.glsl"

Hit met_hit(uint index, Ray ray) { return drawn_hit(index, ray); }
#else
layout(set = 1, binding = 2, std430) readonly buffer Hits { Hit hits[]; };

Hit met_hit(uint index, Ray ray) { return hits[index]; }
#endif

uint met_index() { return gbuffer_ray_index(); }
bool is_met(uint index) { return true; }
Ray met_ray(uint index) { return gbuffer_ray(ivec2(gl_GlobalInvocationID.xy)); }
bool is_last() { return false; }
#else
layout(set = 1, binding = 0, std430) readonly buffer MetCount { RayCount met_count; };
layout(set = 1, binding = 1, std430) readonly buffer MetRays { Ray met_rays[]; };
layout(set = 1, binding = 2, std430) readonly buffer Hits { Hit hits[]; };
layout(push_constant) uniform Constants { uint last_round; };

uint met_index() { return ray_index(); }
bool is_met(uint index) { return index < met_count.count; }
Ray met_ray(uint index) { return met_rays[index]; }
Hit met_hit(uint index, Ray ray) { return hits[index]; }
bool is_last() { return last_round != 0u; }
#endif

void main() {
  uint index = met_index();
  bool goes_on = false;
  Ray ray;
  if (is_met(index)) {
    ray = met_ray(index);
    Hit hit = met_hit(index, ray);
    ivec2 pixel = pixel_of(ray);
    if (hit.instance == hit_none) {
      if (!outside_frame(pixel)) store_nothing(pixel);
    } else {
      HitSurface s = met_surface(ray, hit);
      goes_on = !is_last() && passes(ray, s);
      if (!goes_on) store(pixel, hit, s);
      ray = beyond(ray, hit);
    }
  }
  APPEND_RAY(goes_on, ray)
}
