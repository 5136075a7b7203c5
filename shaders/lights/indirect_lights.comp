#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 16, local_size_y = 16) in;
// A shadow ray toward a point of an emissive triangle for every pixel that has gathered indirect
// light, with the light that it adds.
#include "lib/frame.glsl"
#include "lib/lighting/two_sided_light.glsl"
#include "lib/math/octahedral.glsl"
#include "lib/math/random.glsl"
#include "lib/rays/gathered_pixels.glsl"
#include "lib/rays/ray_stream.glsl"
#include "lib/math/geometry.glsl"
#include "shared/emissive.h"

layout(set = 1, binding = 0, rgba32f) readonly uniform image2D normals;
layout(set = 1, binding = 1, rgba32f) readonly uniform image2D motion;
layout(set = 1, binding = 2, rgba32f) readonly uniform image2D radiance;
layout(set = 1, binding = 3, std430) readonly buffer Points { EmissivePoint points[]; };
layout(set = 1, binding = 4, std430) buffer Count { RayCount ray_count; };
layout(set = 1, binding = 5, std430) writeonly buffer Rays { StoredRay rays[]; };
layout(set = 1, binding = 6, rgba8) readonly uniform image2D base_color;
layout(set = 1, binding = 7, rgba8) readonly uniform image2D surface;
layout(set = 1, binding = 8, rgba32ui) readonly uniform uimage2D surface_layers;
#include "lib/lighting/emissive_choice.glsl"
#include "lib/scene/gbuffer_material.glsl"

/// Factors on the light of each side.
SideShares shares_at(ivec2 pixel) {
  const SideShares one_side = SideShares(vec3(1.0), vec3(0.0), 0.0);
  if (!scene_has(scene_diffuse_transmits) || imageLoad(surface, pixel).w <= 0.0) return one_side;
  SurfaceMaterial m = material_at(pixel);
  if (!scatters_through(m)) return one_side;
  return side_shares(m);
}

bool has_gathered(ivec2 pixel) {
  if (outside_frame(pixel)) return false;
  return imageLoad(motion, pixel).w > 0.0 && imageLoad(radiance, pixel).w >= 0.0;
}

void main() {
  ivec2 own = ivec2(gl_GlobalInvocationID.xy);
  gather_pixel(has_gathered(own), own);
  bool requested = false;
  Ray ray;
  if (has_gathered_pixel()) {
    ivec2 pixel = gathered_pixel();
    float view_z = imageLoad(motion, pixel).w;
    vec4 encoded = imageLoad(normals, pixel);
    vec3 geometric = octahedral_decode(encoded.zw);
    vec3 position = world_position(pixel, view_z);
    vec2 u = random_pair(uvec2(pixel), frame.sample_index, 8u, frame.seed);
    SideShares shares = shares_at(pixel);
    EmissiveChoice choice = choose_emissive(position, octahedral_decode(encoded.xy), geometric,
                                            shares.near, shares.behind, u.x, u.y);
    requested = choice.total > 0.0;
    bool behind = shares.pick_behind > 0.0 && dot(geometric, choice.direction) < 0.0;
    ray.origin = offset_origin(position, behind ? -geometric : geometric, view_z);
    ray.t_min = 0.0;
    ray.direction = choice.direction;
    ray.t_max = choice.distance * 0.999;
    ray.pixel = uint(pixel.x) | uint(pixel.y) << 16u;
    ray.user = floatBitsToUint(choice.light.r);
    ray.padding0 = floatBitsToUint(choice.light.g);
    ray.padding1 = floatBitsToUint(choice.light.b);
  }
  APPEND_RAY(requested, ray)
}
