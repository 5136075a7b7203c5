#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
// The rays that light the chosen blended surface of each pixel, as all others are lit: toward a
// light, into the hemisphere, along its specular lobe. Each carries what it brings.
#include "lib/scene/hit_material.glsl"
#include "lib/lighting/light_choice.glsl"
#include "lib/rays/ray_index.glsl"
#include "lib/rays/ray_stream.glsl"
#include "lib/math/sampling.glsl"
#include "lib/rays/specular_pixels.glsl"
#include "shared/sampling.h"

layout(set = 1, binding = 0, std430) readonly buffer LitCount { RayCount lit_count; };
layout(set = 1, binding = 1, std430) readonly buffer LitRays { Ray lit_rays[]; };
layout(set = 1, binding = 2, std430) readonly buffer Chosen { Hit chosen[]; };
layout(set = 1, binding = 3, rgba32f) readonly uniform image2D radiance;
layout(set = 1, binding = 4, rgba32f) uniform image2D behind;  // a: from weight to view Z
layout(set = 1, binding = 5, rgba8) writeonly uniform image2D surface;
layout(set = 1, binding = 6, std430) buffer ShadowCount { RayCount shadow_count; };
layout(set = 1, binding = 7, std430) writeonly buffer ShadowRays { StoredRay shadow_rays[]; };
layout(set = 1, binding = 8, std430) buffer AmbientCount { RayCount ambient_count; };
layout(set = 1, binding = 9, std430) writeonly buffer AmbientRays { StoredRay ambient_rays[]; };
layout(set = 1, binding = 10, std430) buffer MirrorCount { RayCount mirror_count; };
layout(set = 1, binding = 11, std430) writeonly buffer MirrorRays { StoredRay mirror_rays[]; };
layout(push_constant) uniform Constants {
  float max_roughness;  // below 0: no reflections are traced
  float rough_rate;     // fraction of the rays that rough surfaces reflect which are traced
  uint gathers;         // 1: rays of the ambient stream gather indirect light
};

vec2 pair(ivec2 pixel, uint dimension) {
  return random_pair(uvec2(pixel), frame.sample_index, dimension, frame.seed);
}

Ray carrying(Ray ray, ivec2 pixel, vec3 light) {
  ray.pixel = uint(pixel.x) | uint(pixel.y) << 16u;
  uvec3 bits = floatBitsToUint(light);
  ray.user = bits.r;
  ray.padding0 = bits.g;
  ray.padding1 = bits.b;
  return ray;
}

Ray ray_along(HitSurface s, float view_z, vec3 direction, float t_max) {
  return Ray(offset_origin(s.position, s.geometric, view_z), 0.0, direction, t_max, 0u, 0u, 0u, 0u);
}

/// Light of all lights times visibility, estimated with one ray to a randomly chosen light.
Ray shadow_ray(HitSurface s, SurfaceMaterial m, float view_z, vec3 throughput, ivec2 pixel,
               out bool valid) {
  Ray ray;
  valid = false;
  if (!enabled(frame_direct)) return ray;
  vec3 sum = vec3(0.0);
  for (uint i = 0u; i < frame.light_count; ++i) {
    if (light_reaches(i, s.position)) sum += light_contribution(light_number(i), m, s.position);
  }
  float pick = random_number(uvec2(pixel), frame.sample_index, 40u, frame.seed);
  LightChoice choice = choose_light(m, s.position, pick);
  if (choice.total <= 0.0) return ray;
  ray = light_ray(light_number(choice.number), m, s.position, view_z, pair(pixel, 41u), pick,
                  valid);
  if (!enabled(frame_shadows)) {
    valid = true;
    ray.t_max = 0.0;
  }
  return carrying(ray, pixel, throughput * sum);
}

/// Light from both sides is gathered on one of them, in proportion to what reaches the eye: turns
/// the surface to the side that its ray leaves to, and changes what of the light there does.
void choose_side(inout HitSurface s, inout SurfaceMaterial m, ivec2 pixel, inout vec3 around) {
  if (gathers == 0u || !scatters_through(m)) return;
  float behind = luminance(m.diffuse_transmitted);
  float pick_behind = behind / max(behind + luminance(around), 1e-6);
  float pick = random_number(uvec2(pixel), frame.sample_index, side_dimension, frame.seed);
  if (pick >= pick_behind) {
    around /= 1.0 - pick_behind;
    return;
  }
  around = m.diffuse_transmitted / pick_behind;
  m.normal = -m.normal;
  m.geometric = -m.geometric;
  s.geometric = -s.geometric;
}

/// `light` comes along it, or is what the light that it gathers is multiplied by.
Ray ambient_ray(HitSurface s, SurfaceMaterial m, float view_z, vec3 light, ivec2 pixel,
                out bool valid) {
  vec3 direction = sample_cosine(m.normal, pair(pixel, 42u));
  Ray ray = ray_along(s, view_z, direction, gathers != 0u ? 1e30 : frame.ambient_radius);
  bool open = gathers == 0u && !enabled(frame_ambient_occlusion);
  if (open) ray.t_max = 0.0;
  valid = (open || dot(direction, m.geometric) > 0.0) && light != vec3(0.0);
  return carrying(ray, pixel, light);
}

/// Rough surfaces other than metals reflect little, and what they reflect is noisy anyhow.
float reflection_rate(float roughness, float metallic) {
  return roughness < plan_smooth_roughness || metallic > plan_metallic ? 1.0 : rough_rate;
}

void main() {
  uint index = ray_index();
  bool lit = false, open = false, mirrors = false;
  Ray shadow, ambient, specular;
  if (index < lit_count.count) {
    Ray view = lit_rays[index];
    ivec2 pixel = ivec2(view.pixel & 0xffffu, view.pixel >> 16u);
    Hit hit = chosen[uint(pixel.y) * frame.extent.x + uint(pixel.x)];
    vec4 seen = imageLoad(behind, pixel);
    vec3 throughput = uintBitsToFloat(uvec3(hit.padding0, hit.padding1, hit.padding2)) *
                 (imageLoad(radiance, pixel).a / seen.a);
    HitSurface s = hit_surface(hit, view.direction, cone_width(camera_cone(), hit.t));
    SurfaceMaterial m = material_of(s, view.direction);
    float view_z = -(frame.view * vec4(s.position, 1.0)).z;
    shadow = shadow_ray(s, m, view_z, throughput, pixel, lit);
    vec3 around = enabled(frame_environment_diffuse) ? environment_diffuse(m) : vec3(0.0);
    if (gathers != 0u) around = wide_albedo(m);
    if (traces_specular(specular_roughness(m), max_roughness)) {
      SpecularSample drawn = sample_specular(m, pair(pixel, 43u));
      float rate = reflection_rate(specular_roughness(m), s.metallic);
      mirrors = any(greaterThan(drawn.weight, vec3(0.0))) &&
                random_number(uvec2(pixel), frame.sample_index, 50u, frame.seed) < rate;
      specular = carrying(ray_along(s, view_z, drawn.direction, 1e30), pixel,
                          throughput * drawn.weight / rate);
    } else if (gathers != 0u) {
      around += m.specular_albedo;
    } else if (enabled(frame_environment_specular)) {
      around += environment_specular(m);
    }
    float roughness = specular_roughness(m);
    choose_side(s, m, pixel, around);
    ambient = ambient_ray(s, m, view_z, throughput * around * (gathers != 0u ? 1.0 : s.occlusion),
                          pixel, open);
    imageStore(behind, pixel, vec4(seen.rgb, view_z));
    imageStore(surface, pixel, vec4(roughness, s.metallic, 0.0, 0.0));
  }
  APPEND_RAY_TO(shadow_count, shadow_rays, lit, shadow)
  APPEND_RAY_TO(ambient_count, ambient_rays, open, ambient)
  APPEND_RAY_TO(mirror_count, mirror_rays, mirrors, specular)
}
