#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
// One blended surface more of each ray, from front to back: what it sends out by itself, and how
// much of what is behind still shows. One surface of each pixel is chosen for the rays that light
// it, in proportion to the light it would send to the eye if nothing occluded it.
#include "lib/rays/stored_rays.glsl"
#include "lib/scene/hit_material.glsl"
#include "lib/lighting/lights.glsl"
#include "lib/lighting/transmission.glsl"
#include "lib/math/random.glsl"
#include "lib/rays/ray_index.glsl"
#include "lib/rays/ray_stream.glsl"

layout(set = 1, binding = 0, std430) readonly buffer MetCount { RayCount met_count; };
layout(set = 1, binding = 1, std430) readonly buffer MetRays { Ray met_rays[]; };
layout(set = 1, binding = 2, std430) readonly buffer Hits { Hit hits[]; };
layout(set = 1, binding = 3, std430) readonly buffer Before { Vertex previous_vertices[]; };
layout(set = 1, binding = 4, std430) buffer Count { RayCount ray_count; };
layout(set = 1, binding = 5, std430) writeonly buffer Rays { StoredRay rays[]; };
layout(set = 1, binding = 6, rgba32f) uniform image2D radiance;  // a: sum of all weights
layout(set = 1, binding = 7, rgba32f) uniform image2D behind;    // a: weight of the chosen one
layout(set = 1, binding = 8, rgba32f) writeonly uniform image2D front_motion;
layout(set = 1, binding = 9, std430) writeonly buffer Chosen { StoredHit chosen[]; };  // by pixel
layout(set = 1, binding = 10, std430) buffer LitCount { RayCount lit_count; };
layout(set = 1, binding = 11, std430) writeonly buffer LitRays { StoredRay lit_rays[]; };
layout(push_constant) uniform Constants {
  uint round;
  uint last_round;
};

#include "lib/scene/hit_motion.glsl"

const float least_seen = 1.0 / 512.0;  // of what is behind: less changes nothing

/// As if nothing occluded it. `bends`: what is behind it shows along a ray of its own.
vec3 open_light(HitSurface s, SurfaceMaterial m, bool bends) {
  vec3 sum = vec3(0.0);
  for (uint i = 0u; enabled(frame_direct) && i < frame.light_count; ++i) {
    if (light_reaches(i, s.position)) sum += light_contribution(light_number(i), m, s.position);
  }
  if (enabled(frame_environment_diffuse)) sum += environment_diffuse(m);
  if (enabled(frame_environment_specular)) sum += environment_specular(m);
  if (bends) sum += m.transmitted * environment_reflection(-m.eye, m.roughness);
  return sum;
}

/// `throughput` of the surface's light reaches the eye. The chosen hit carries it.
void choose(ivec2 pixel, Hit hit, HitSurface s, SurfaceMaterial m, bool bends, vec3 throughput,
            inout float total, inout float weight) {
  // Never 0: reflections may show what emits where the environment does not.
  float own = luminance(throughput * open_light(s, m, bends)) + 1e-3 * luminance(throughput);
  if (!(own > 0.0)) return;
  total += own;
  if (random_number(uvec2(pixel), frame.sample_index, 44u + round, frame.seed) * total >= own) return;
  weight = own;
  hit.padding0 = floatBitsToUint(throughput.r);
  hit.padding1 = floatBitsToUint(throughput.g);
  hit.padding2 = floatBitsToUint(throughput.b);
  chosen[uint(pixel.y) * frame.extent.x + uint(pixel.x)] = stored(hit);
}

/// Whether anything behind it still shows. `first`: whether it is the first of its pixel to be lit.
bool lay_over(ivec2 pixel, Hit hit, HitSurface s, SurfaceMaterial m, bool bends, out bool first) {
  vec4 light = imageLoad(radiance, pixel);
  vec4 seen = imageLoad(behind, pixel);
  vec3 throughput = seen.rgb * s.alpha;
  light.rgb += throughput * own_light(s);
  first = light.a == 0.0;
  if (!is_unlit(s)) choose(pixel, hit, s, m, bends, throughput, light.a, seen.a);
  first = first && light.a > 0.0;
  bool most_seen = luminance(seen.rgb) >= 0.5;
  seen.rgb *= bends ? vec3(1.0 - s.alpha) : seen_behind(s, m);
  if (most_seen && luminance(seen.rgb) < 0.5) {
    float view_z = -(frame.view * vec4(s.position, 1.0)).z;
    imageStore(front_motion, pixel, motion_of(hit, s, view_z));
  }
  imageStore(radiance, pixel, light);
  imageStore(behind, pixel, seen);
  return max(seen.r, max(seen.g, seen.b)) > least_seen;
}

void main() {
  uint index = ray_index();
  bool goes_on = false, lit = false;
  Ray ray, view;
  if (index < met_count.count && hits[index].instance != hit_none) {
    ray = view = met_rays[index];
    Hit hit = hits[index];
    ivec2 pixel = ivec2(ray.pixel & 0xffffu, ray.pixel >> 16u);
    HitSurface s = hit_surface(hit, ray.direction, cone_width(camera_cone(), hit.t));
    goes_on = is_open(s, ray.direction);
    if (!goes_on && is_blended(s)) {
      bool bends = bends_light(s, boundary_of(hit, s, ray.direction));
      goes_on = lay_over(pixel, hit, s, material_of(s, ray.direction), bends, lit);
    }
    goes_on = goes_on && last_round == 0u;
    ray = beyond(ray, hit);
  }
  APPEND_RAY(goes_on, ray)
  APPEND_RAY_TO(lit_count, lit_rays, lit, view)
}
