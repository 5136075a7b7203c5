#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// What the specular ray hit, lit as the hybrid lights it: emission, the environment as if nothing
// hid it, and one light as far as its shadow ray will find.
#include "lib/rays/reference_path.glsl"
#include "lib/rays/stored_rays.glsl"

layout(set = 1, binding = 0, std430) readonly buffer Rays { Ray rays[]; };
layout(set = 1, binding = 1, std430) readonly buffer Hits { Hit hits[]; };
layout(set = 1, binding = 2, std430) readonly buffer Paths { ReferencePath paths[]; };
layout(set = 1, binding = 3, std430) writeonly buffer ShadowCount { RayCount shadow_count; };
layout(set = 1, binding = 4, std430) writeonly buffer ShadowRays { StoredRay shadow_rays[]; };
layout(set = 1, binding = 5, rgba32f) uniform image2D reference;
layout(push_constant) uniform Constants { ReferenceConstants constants; };

Ray light_shadow_ray(SurfaceMaterial m, vec3 position, vec3 throughput, ivec2 pixel) {
  if (constants.with_lights == 0u || !enabled(frame_direct)) return no_ray();
  float pick = path_number(pixel, constants.round, 1u);
  LightChoice choice = choose_light(m, position, pick);
  if (choice.total <= 0.0) return no_ray();
  Light light = light_number(choice.number);
  bool valid = false;
  Ray ray = light_ray(light, m, position, 0.0, path_pair(pixel, constants.round, 2u), pick, valid);
  if (!valid) return no_ray();
  carry(ray, throughput * light_contribution(light, m, position) * (choice.total / choice.weight));
  if (!enabled(frame_shadows)) ray.t_max = 0.0;
  return ray;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (outside_frame(pixel)) return;
  uint index = pixel_index(pixel);
  if (index == 0u) shadow_count = dense_stream(frame_blending());
  Ray ray = rays[index];
  Ray shadow = no_ray();
  if (is_wanted(ray)) {
    Hit hit = hits[index];
    ReferencePath path = paths[index];
    vec3 radiance = vec3(0.0);
    if (hit.instance == hit_none) {
      if (enabled(frame_environment_specular)) radiance = environment_radiance(ray.direction);
    } else {
      RayCone cone = RayCone(path.cone_width, path.cone_spread);
      HitSurface s = hit_surface(hit, ray.direction, cone_width(cone, hit.t));
      path.throughput *= stopped_weight(s);
      radiance = own_light(s);
      if (!is_unlit(s)) {
        SurfaceMaterial m = material_of(s, ray.direction);
        if (enabled(frame_environment_diffuse)) radiance += environment_diffuse(m);
        if (enabled(frame_environment_specular)) radiance += environment_specular(m);
        shadow = light_shadow_ray(m, s.position, path.throughput, pixel);
      }
    }
    vec3 sum = imageLoad(reference, pixel).rgb + path.throughput * radiance;
    imageStore(reference, pixel, vec4(sum, 1.0));
  }
  shadow_rays[index] = stored(shadow);
}
