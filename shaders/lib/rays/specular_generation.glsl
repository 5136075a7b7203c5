// One specular ray per pixel, or per 2x2, from the visible normals of the surface's roughness.
// HALF_RESOLUTION: rays carry no weight; the direction that each cell took is kept, so that the
// pixels of the cell can weigh what it saw by their own lobes.
#ifndef HELIOGRAPH_SPECULAR_GENERATION_GLSL
#define HELIOGRAPH_SPECULAR_GENERATION_GLSL
#include "lib/frame.glsl"
#include "lib/denoise/moments.glsl"
#include "lib/rays/gathered_pixels.glsl"
#include "lib/rays/ray_stream.glsl"
#include "lib/math/sampling.glsl"
#include "lib/rays/sampling_plan.glsl"
#include "lib/rays/specular_pixels.glsl"

layout(set = 1, binding = 0, rgba32f) readonly uniform image2D normals;
layout(set = 1, binding = 1, rgba8) readonly uniform image2D base_color;
layout(set = 1, binding = 2, rgba8) readonly uniform image2D surface;
layout(set = 1, binding = 3, rgba32ui) readonly uniform uimage2D surface_layers;
layout(set = 1, binding = 4, rgba32f) readonly uniform image2D motion;
layout(set = 1, binding = 5, std430) buffer Count { RayCount ray_count; };
layout(set = 1, binding = 6, std430) writeonly buffer Rays { StoredRay rays[]; };
layout(set = 1, binding = 7, r32ui) readonly uniform uimage2D planned;  // or anything
layout(set = 1, binding = 8, rgba32f) writeonly uniform image2D radiance;
#ifdef HALF_RESOLUTION
layout(set = 1, binding = 9, rgba32f) writeonly uniform image2D directions;
const int scale = 2;
#else
const int scale = 1;
#endif
layout(push_constant) uniform Constants {
  float max_roughness;
  uint by_plan;
};

#include "lib/scene/gbuffer_material.glsl"

uint planned_word(ivec2 pixel) {
  return by_plan != 0u ? imageLoad(planned, pixel).r : plan_specular;
}

/// `seen`: radiance and distance; `taken`: direction and density.
void leave(ivec2 cell, vec4 seen, vec4 taken) {
  imageStore(radiance, cell, seen);
#ifdef HALF_RESOLUTION
  imageStore(directions, cell, taken);
#endif
}

bool wants_sample(ivec2 cell) {
  if (any(greaterThanEqual(cell, (ivec2(frame.extent) + scale - 1) / scale))) return false;
  ivec2 pixel = traced_pixel(cell, scale);
  bool surface_there = imageLoad(motion, pixel).w > 0.0;
  uint word = planned_word(pixel);
  bool left_out = surface_there && (word & plan_specular) == 0u;
  if (surface_there && !left_out && !is_unlit(pixel)) return true;
  // A negative distance: no sample, and how far it was in the frame before.
  float away = left_out ? min(-distance_before(word), -1e-6) : 0.0;
  leave(cell, vec4(vec3(0.0), away), vec4(0.0));
  return false;
}

void main() {
  ivec2 own = ivec2(gl_GlobalInvocationID.xy);
  gather_pixel(wants_sample(own), own);
  bool requested = false;
  Ray ray;
  if (has_gathered_pixel()) {
    ivec2 cell = gathered_pixel();
    ivec2 pixel = traced_pixel(cell, scale);
    float view_z = imageLoad(motion, pixel).w;
    uint word = planned_word(pixel);
    vec4 seen = vec4(0.0);
    SurfaceMaterial m = material_at(pixel);
    SpecularSample s = sample_specular(m, specular_pair(cell, 4u, scale));
    vec3 weight = s.weight / specular_demodulator(m);
#ifdef HALF_RESOLUTION
    if (weight != vec3(0.0)) weight = vec3(1.0);
#endif
    requested = traces_specular(specular_roughness(m), max_roughness);
    if (requested && (word & plan_environment) != 0u) {
      float away = distance_before(word);
      seen = vec4(sanitize(expected_reflection(m, ambient_before(word))),
                  away > 0.0 ? away : distance_of_misses);
      requested = false;
    }
    requested = requested && any(greaterThan(weight, vec3(0.0)));
    ray.origin = offset_origin(world_position(pixel, view_z), m.geometric, view_z);
    ray.t_min = 0.0;
    ray.direction = s.direction;
    ray.t_max = 1e30;
    ray.pixel = uint(pixel.x) | uint(pixel.y) << 16u;
    ray.user = floatBitsToUint(weight.r);
    ray.padding0 = floatBitsToUint(weight.g);
    ray.padding1 = floatBitsToUint(weight.b);
    leave(cell, seen, vec4(s.direction, s.density));
  }
  APPEND_RAY(requested, ray)
}

#endif
