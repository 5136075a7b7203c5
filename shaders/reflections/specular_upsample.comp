#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// Reflections of every pixel from the rays of the four 2x2 cells around it: those of the same
// surface, each weighed by how likely the pixel itself would have sent it, over how likely the
// cell's did (the ratio of Stachowiak 2015, which keeps constant light constant).
#include "lib/frame.glsl"
#include "lib/math/sampling.glsl"
#include "lib/rays/specular_pixels.glsl"

layout(set = 1, binding = 0, rgba32f) readonly uniform image2D normals;
layout(set = 1, binding = 1, rgba8) readonly uniform image2D base_color;
layout(set = 1, binding = 2, rgba8) readonly uniform image2D surface;
layout(set = 1, binding = 3, rgba32ui) readonly uniform uimage2D surface_layers;
layout(set = 1, binding = 4, rgba32f) readonly uniform image2D motion;
layout(set = 1, binding = 5, rgba32f) readonly uniform image2D half_radiance;
layout(set = 1, binding = 6, rgba32f) readonly uniform image2D directions;
layout(set = 1, binding = 7, rgba32f) writeonly uniform image2D radiance;
layout(push_constant) uniform Constants { float max_roughness; };

#include "lib/scene/gbuffer_material.glsl"

const float smooth_roughness = 0.15;  // below, lobes are too narrow for neighbours

// What a cell's weight falls to 1/e at: about 10 degrees between normals, 1 % of the distance off
// the plane, an eighth of roughness, and 2 pixels. Chosen on the test scenes.
const float normal_power = 64.0;
const float depth_tolerance = 0.01;
const float roughness_falloff = 64.0;
const float distance_falloff = 0.25;

/// BRDF x cos of the pixel's lobe without Fresnel's term, over the density of the cell's.
float lobe_ratio(SurfaceMaterial m, vec4 direction) {
  if (has_coat(m) || m.roughness < smooth_roughness) return 1.0;
  vec3 l = direction.xyz;
  if (dot(m.normal, l) <= 0.0) return 0.0;
  return min(base_lobe(m, l) / max(direction.w, 1e-6), 16.0);
}

/// How far the pixel that a cell traced for is of the same surface, 0..1.
float likeness(SurfaceMaterial m, vec3 position, float view_z, ivec2 pixel, ivec2 other) {
  float other_z = imageLoad(motion, other).w;
  if (other_z <= 0.0) return 0.0;
  vec3 normal = octahedral_decode(imageLoad(normals, other).xy);
  float off_plane = abs(dot(m.geometric, world_position(other, other_z) - position));
  float roughness = imageLoad(surface, other).x - specular_roughness(m);
  vec2 offset = vec2(other - pixel);
  return pow(max(dot(normal, m.normal), 0.0), normal_power) *
         exp(-off_plane / (depth_tolerance * view_z)) *
         exp(-roughness_falloff * roughness * roughness) *
         exp(-distance_falloff * dot(offset, offset));
}

vec4 gathered(SurfaceMaterial m, ivec2 pixel, float view_z) {
  vec3 position = world_position(pixel, view_z);
  ivec2 cell = pixel / 2;
  ivec2 aside = (pixel & 1) * 2 - 1;
  ivec2 last = (ivec2(frame.extent) + 1) / 2 - 1;
  vec4 sum = vec4(0.0);
  float total = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 other = cell + aside * ivec2(i & 1, i >> 1);
    if (any(lessThan(other, ivec2(0))) || any(greaterThan(other, last))) continue;
    vec4 seen = imageLoad(half_radiance, other);
    if (seen.w <= 0.0) continue;
    float weight = likeness(m, position, view_z, pixel, traced_pixel(other, 2)) *
                   lobe_ratio(m, imageLoad(directions, other));
    sum += weight * seen;
    total += weight;
  }
  // No neighbour is similar to this pixel: the prefiltered environment is used.
  if (total < 1e-4) {
    vec3 reflected = reflect(-m.eye, reflection_normal(m));
    vec3 light = enabled(frame_environment_specular)
                     ? environment_reflection(reflected, specular_roughness(m)) : vec3(0.0);
    return vec4(light, 1e4);
  }
  return sum / total;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (outside_frame(pixel)) return;
  float view_z = imageLoad(motion, pixel).w;
  vec4 result = vec4(0.0);
  if (view_z > 0.0 && !is_unlit(pixel)) {
    SurfaceMaterial m = material_at(pixel);
    if (traces_specular(specular_roughness(m), max_roughness)) result = gathered(m, pixel, view_z);
  }
  imageStore(radiance, pixel, result);
}
