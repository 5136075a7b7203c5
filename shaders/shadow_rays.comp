#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// One shadow ray per pixel toward one light, chosen in proportion to what the surface sends to the
// eye of its unshadowed light, so that the expected visibility is the ratio sum(L V) / sum(L)
// (Heitz et al. 2018).
#include "lib/environment.glsl"
#include "lib/geometry.glsl"
#include "lib/lights.glsl"
#include "lib/octahedral.glsl"
#include "lib/random.glsl"
#include "lib/ray_stream.glsl"

layout(set = 1, binding = 0, rgba32f) readonly uniform image2D normals;
layout(set = 1, binding = 1, rgba32f) readonly uniform image2D motion;
layout(set = 1, binding = 2, rgba8) readonly uniform image2D base_color;
layout(set = 1, binding = 3, rgba8) readonly uniform image2D surface;
layout(set = 1, binding = 4, std430) buffer Count { RayCount ray_count; };
layout(set = 1, binding = 5, std430) writeonly buffer Rays { Ray rays[]; };
layout(set = 1, binding = 6, r32f) writeonly uniform image2D visibility;

const uint area_candidates = 4u;

SurfaceMaterial material_at(ivec2 pixel) {
  vec4 encoded = imageLoad(normals, pixel);
  vec4 color = imageLoad(base_color, pixel);
  vec4 packed_surface = imageLoad(surface, pixel);
  return surface_material(color.rgb * color.rgb, packed_surface.y, packed_surface.x,
                          octahedral_decode(encoded.xy), octahedral_decode(encoded.zw),
                          to_eye(pixel));
}

/// Takes one of several: `pick` decides with the new one's share of the total and stays uniform.
bool takes(float weight, inout float total, inout float pick) {
  if (!(weight > 0.0)) return false;
  total += weight;
  float share = weight / total;
  bool taken = pick < share;
  pick = taken ? pick / share : (pick - share) / (1.0 - share);
  return taken;
}

/// A point of an area light in proportion to the light that it sends to the eye, near enough: one
/// of a few (resampling; Talbot et al. 2005), so that visibility stays 0 or 1 and what is lit
/// everywhere stays free of noise.
LightSample sample_lit_point(Light light, SurfaceMaterial m, vec3 position, vec2 u, float pick,
                             out bool found) {
  LightSample chosen;
  float total = 0.0;
  for (uint i = 0u; i < area_candidates; ++i) {
    // Steps of the R2 sequence (Roberts 2018).
    vec2 at = fract(u + float(i) * vec2(0.7548776662, 0.5698402910));
    LightSample s = sample_light(light, position, at);
    float cosine = dot(m.geometric, s.ray_direction);
    float weight = cosine > 0.0 ? luminance(s.irradiance * shade_light(m, s.direction)) : 0.0;
    if (takes(weight, total, pick)) chosen = s;
  }
  found = total > 0.0;
  return chosen;
}

Ray shadow_ray(LightSample s, vec3 position, vec3 geometric, float view_z, ivec2 pixel) {
  Ray ray;
  ray.origin = offset_origin(position, geometric, view_z);
  ray.t_min = 0.0;
  ray.direction = s.ray_direction;
  // Geometry may lie where an area light does and show it: it must not be in its own way.
  ray.t_max = s.distance * 0.999;
  ray.pixel = uint(pixel.x) | uint(pixel.y) << 16u;
  ray.user = 0u;
  ray.padding0 = 0u;
  ray.padding1 = 0u;
  return ray;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  bool wanted = false;
  Ray ray;
  float view_z = outside_frame(pixel) ? 0.0 : imageLoad(motion, pixel).w;
  if (view_z > 0.0) {
    SurfaceMaterial m = material_at(pixel);
    vec3 position = world_position(pixel, view_z);
    float total = 0.0;
    uint chosen = 0u;
    float pick = random_number(uvec2(pixel), frame.extent.z, 1u, frame.extent.w);
    for (uint i = 0u; i < frame.counts.x; ++i) {
      float weight = luminance(light_contribution(light_number(i), m, position));
      if (takes(weight, total, pick)) chosen = i;
    }
    if (total > 0.0) {
      vec2 u = random_pair(uvec2(pixel), frame.extent.z, 2u, frame.extent.w);
      Light light = light_number(chosen);
      LightSample s;
      if (light.type >= light_rectangle) {
        s = sample_lit_point(light, m, position, u, pick, wanted);
      } else {
        s = sample_light(light, position, u);
        // The light's disk may reach below the horizon, where nothing of it is seen.
        wanted = dot(s.ray_direction, m.geometric) > 0.0;
      }
      if (wanted) ray = shadow_ray(s, position, m.geometric, view_z, pixel);
    }
  }
  if (!outside_frame(pixel)) imageStore(visibility, pixel, vec4(wanted ? 1.0 : 0.0));
  APPEND_RAY(wanted, ray)
}
