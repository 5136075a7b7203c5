#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/rays/ray_index.glsl"
layout(local_size_x = 64) in;
// One boundary more of the rays that a blended surface has sent into its volume: those that come
// out are left to be shaded, others go on inside.
#include "lib/scene/hit_material.glsl"
#include "lib/lighting/transmission.glsl"
#include "lib/math/random.glsl"
#include "lib/rays/ray_stream.glsl"

layout(set = 1, binding = 0, std430) readonly buffer InsideCount { RayCount inside_count; };
layout(set = 1, binding = 1, std430) readonly buffer InsideRays { Ray inside_rays[]; };
layout(set = 1, binding = 2, std430) readonly buffer Hits { Hit hits[]; };
layout(set = 1, binding = 3, std430) readonly buffer Chosen { Hit chosen[]; };  // by pixel
layout(set = 1, binding = 4, std430) buffer NextCount { RayCount next_count; };
layout(set = 1, binding = 5, std430) writeonly buffer NextRays { StoredRay next_rays[]; };
layout(set = 1, binding = 6, std430) buffer RefractedCount { RayCount refracted_count; };
layout(set = 1, binding = 7, std430) writeonly buffer RefractedRays { StoredRay refracted_rays[]; };
layout(push_constant) uniform Constants {
  uint round;
  uint last_round;
};

/// What happens to `ray` at the boundary where it meets `s`. `band`: that it has in the volume that
/// it has entered. `weight`: what its light is multiplied by. @return whether it stays inside
bool cross_boundary(inout Ray ray, HitSurface s, Boundary boundary, uint band, ivec2 pixel,
                    inout vec3 weight) {
  SurfaceMaterial m = material_of(s, ray.direction);
  uint dimension = boundary_dimension + 2u * round;
  float pick = random_number(uvec2(pixel), frame.sample_index, dimension, frame.seed);
  vec2 u = random_pair(uvec2(pixel), frame.sample_index, dimension + 1u, frame.seed);
  float index = refraction_index(boundary.medium, band);
  Departure d = sample_departure(s, m, index, pick, u);
  weight *= d.weight;
  // After the last boundary all light goes on as if nothing bent it.
  bool stays = !d.outside && last_round == 0u;
  if (d.outside || stays) ray.direction = d.direction;
  ray.origin = offset_origin(s.position, stays ? s.geometric : -s.geometric, 0.0);
  return stays;
}

void main() {
  uint index = ray_index();
  bool stays = false, leaves = false;
  Ray ray;
  if (index < inside_count.count) {
    ray = inside_rays[index];
    Hit hit = hits[index];
    ivec2 pixel = ivec2(ray.pixel & 0xffffu, ray.pixel >> 16u);
    Hit entered = chosen[uint(pixel.y) * frame.extent.x + uint(pixel.x)];
    uint medium = layer_number(entered);
    uint band = pixel_band(medium, pixel);
    vec3 weight = uintBitsToFloat(uvec3(ray.user, ray.padding0, ray.padding1));
    if (hit.instance == hit_none) {
      // The mesh is not closed: as if its volume were as thick as the material says.
      weight *= exp(-layers[medium].absorption * instances[entered.instance].scale);
    } else {
      weight *= left_by_volume(medium, hit.t);
      float width = cone_width(camera_cone(), entered.t + hit.t);
      HitSurface s = hit_surface(hit, ray.direction, width);
      Boundary boundary = boundary_of(hit, s, ray.direction);
      if (boundary.leaving) stays = cross_boundary(ray, s, boundary, band, pixel, weight);
    }
    uvec3 bits = floatBitsToUint(weight);
    ray.user = bits.r;
    ray.padding0 = bits.g;
    ray.padding1 = bits.b;
    // Neighbours are to see that nothing is left of a band.
    bool carries = band != 0u || any(greaterThan(weight, vec3(0.0)));
    leaves = carries && !stays;
    stays = carries && stays;
  }
  APPEND_RAY_TO(next_count, next_rays, stays, ray)
  APPEND_RAY_TO(refracted_count, refracted_rays, leaves, ray)
}
