#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 16, local_size_y = 16) in;
// One ray per pixel that gathers what comes from the environment and from other surfaces: in
// proportion to the cosine and to what the path guide has learnt. It leaves to the other side of a
// surface that scatters light through in proportion to what comes from there.
#include "lib/frame.glsl"
#include "lib/lighting/two_sided_light.glsl"
#include "lib/math/octahedral.glsl"
#include "lib/math/random.glsl"
#include "lib/rays/gathered_pixels.glsl"
#include "lib/rays/ray_stream.glsl"
#include "lib/rays/sampling_plan.glsl"
#include "lib/math/geometry.glsl"
#include "shared/path_guide.h"

layout(set = 1, binding = 0, rgba32f) readonly uniform image2D normals;
layout(set = 1, binding = 1, rgba32f) readonly uniform image2D motion;
layout(set = 1, binding = 2, std430) buffer Count { RayCount ray_count; };
layout(set = 1, binding = 3, std430) writeonly buffer Rays { StoredRay rays[]; };
layout(set = 1, binding = 4, r32ui) readonly uniform uimage2D planned;  // or anything
layout(set = 1, binding = 5, rgba32f) writeonly uniform image2D radiance;
layout(set = 1, binding = 6, std430) readonly buffer Guide { GuideEntry guide[]; };
layout(set = 1, binding = 7, rgba8) readonly uniform image2D base_color;
layout(set = 1, binding = 8, rgba8) readonly uniform image2D surface;
layout(set = 1, binding = 9, rgba32ui) readonly uniform uimage2D surface_layers;
layout(push_constant) uniform Constants {
  uint by_plan;
  uint guided;
  float cell_angle;  // of the radiance cache
  float least_size;
};
#include "lib/lighting/path_guide.glsl"
#include "lib/scene/gbuffer_material.glsl"

/// Turns the normals of a pixel that scatters light through to the side that its ray leaves to.
/// @return what the light is multiplied by, to pack; 0: nothing
uint choose_side(ivec2 pixel, inout vec3 shading, inout vec3 geometric, out float weight) {
  weight = 1.0;
  if (!scene_has(scene_diffuse_transmits) || imageLoad(surface, pixel).w <= 0.0) return 0u;
  SurfaceMaterial m = material_at(pixel);
  if (!scatters_through(m)) return 0u;
  SideShares shares = side_shares(m);
  float pick = random_number(uvec2(pixel), frame.sample_index, side_dimension, frame.seed);
  bool behind = pick < shares.pick_behind;
  if (behind) {
    shading = -shading;
    geometric = -geometric;
  }
  weight = 1.0 / (behind ? shares.pick_behind : 1.0 - shares.pick_behind);
  return pack_side_share(behind ? shares.behind : shares.near);
}

bool wants_ray(ivec2 pixel) {
  if (outside_frame(pixel)) return false;
  bool seen = imageLoad(motion, pixel).w > 0.0;
  bool left_out = seen && by_plan != 0u && (imageLoad(planned, pixel).r & plan_ambient) == 0u;
  imageStore(radiance, pixel, vec4(0.0, 0.0, 0.0, left_out ? no_sample : 1.0));
  return seen && !left_out;
}

void main() {
  ivec2 own = ivec2(gl_GlobalInvocationID.xy);
  gather_pixel(wants_ray(own), own);
  bool requested = has_gathered_pixel();
  Ray ray;
  if (requested) {
    ivec2 pixel = gathered_pixel();
    float view_z = imageLoad(motion, pixel).w;
    vec4 encoded = imageLoad(normals, pixel);
    vec3 shading = octahedral_decode(encoded.xy);
    vec3 geometric = octahedral_decode(encoded.zw);
    float side_weight;
    uint side_share = choose_side(pixel, shading, geometric, side_weight);
    vec2 u = random_pair(uvec2(pixel), frame.sample_index, 3u, frame.seed);
    vec3 position = world_position(pixel, view_z);
    GuidedPair pair = GuidedPair(u, 0u, 1.0);
    if (guided != 0u) pair = guided_pair_at(position, geometric, u, cell_angle, least_size);
    ray.origin = offset_origin(position, geometric, view_z);
    ray.t_min = 0.0;
    ray.direction = sample_cosine_by_axis(shading, pair.u);
    ray.t_max = 1e30;
    ray.pixel = uint(pixel.x) | uint(pixel.y) << 16u;
    // Directions below the surface, which a shading normal allows, are turned up: none is lost.
    ray.direction -= 2.0 * min(dot(ray.direction, geometric), 0.0) * geometric;
    ray.user = side_share;
    ray.padding0 = floatBitsToUint(pair.weight * side_weight);
    // The density without a guide.
    ray.padding1 = floatBitsToUint(max(dot(ray.direction, shading), 0.0) / pi);
  }
  APPEND_RAY(requested, ray)
}
