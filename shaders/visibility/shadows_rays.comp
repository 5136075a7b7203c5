#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 16, local_size_y = 16) in;
// One shadow ray per pixel toward one light, chosen in proportion to what the surface sends to the
// eye of its unshadowed light, so that the expected visibility is the ratio sum(L V) / sum(L)
// (Heitz et al. 2018).
#include "lib/lighting/light_choice.glsl"
#include "lib/math/random.glsl"
#include "lib/rays/gathered_pixels.glsl"
#include "lib/rays/ray_stream.glsl"

layout(set = 1, binding = 0, rgba32f) readonly uniform image2D normals;
layout(set = 1, binding = 1, rgba32f) readonly uniform image2D motion;
layout(set = 1, binding = 2, rgba8) readonly uniform image2D base_color;
layout(set = 1, binding = 3, rgba8) readonly uniform image2D surface;
layout(set = 1, binding = 4, rgba32ui) readonly uniform uimage2D surface_layers;
layout(set = 1, binding = 5, std430) buffer Count { RayCount ray_count; };
layout(set = 1, binding = 6, std430) writeonly buffer Rays { StoredRay rays[]; };
layout(set = 1, binding = 7, r32ui) readonly uniform uimage2D planned;  // or anything
layout(set = 1, binding = 8, r32f) writeonly uniform image2D visibility;
layout(push_constant) uniform Constants { uint by_plan; };

#include "lib/rays/visibility_pixels.glsl"
#include "lib/scene/gbuffer_material.glsl"

void main() {
  ivec2 own = ivec2(gl_GlobalInvocationID.xy);
  gather_pixel(wants_ray(own, plan_shadows, 0.0), own);
  bool requested = false;
  Ray ray;
  if (has_gathered_pixel()) {
    ivec2 pixel = gathered_pixel();
    float view_z = imageLoad(motion, pixel).w;
    SurfaceMaterial m = material_at(pixel);
    vec3 position = world_position(pixel, view_z);
    float pick = random_number(uvec2(pixel), frame.sample_index, 1u, frame.seed);
    // As composition does: the visibility is that of the light that it adds.
    float picks =
        random_number(uvec2(pixel), frame.sample_index, light_picks_dimension, frame.seed);
    LightChoice choice = choose_light(m, position, picks, pick);
    if (choice.total > 0.0) {
      vec2 u = random_pair(uvec2(pixel), frame.sample_index, 2u, frame.seed);
      ray = light_ray(light_number(choice.number), m, position, view_z, u, pick, requested);
      ray.pixel = uint(pixel.x) | uint(pixel.y) << 16u;
    }
    leave(pixel, requested ? 1.0 : 0.0);
  }
  APPEND_RAY(requested, ray)
}
