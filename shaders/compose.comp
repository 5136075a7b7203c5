#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// Deferred composition: analytic light x traced visibility, image based light, emission.
#include "lib/brdf.glsl"
#include "lib/environment.glsl"
#include "lib/lights.glsl"
#include "lib/octahedral.glsl"

layout(set = 1, binding = 0, rgba32f) readonly uniform image2D normals;
layout(set = 1, binding = 1, rgba8) readonly uniform image2D base_color;
layout(set = 1, binding = 2, rgba8) readonly uniform image2D surface;
layout(set = 1, binding = 3, rgba32f) readonly uniform image2D motion;
layout(set = 1, binding = 4, rgba16f) readonly uniform image2D emissive;
layout(set = 1, binding = 5, r32f) readonly uniform image2D shadow_visibility;
layout(set = 1, binding = 6, r32f) readonly uniform image2D ambient_visibility;
layout(set = 1, binding = 7, rgba32f) readonly uniform image2D background;
layout(set = 1, binding = 8, rgba32f) writeonly uniform image2D hdr;

struct Surface {
  vec3 position;
  vec3 normal;
  vec3 geometric;
  vec3 eye;
  vec3 color;
  float metallic;
  float roughness;
  vec3 f0;
};

vec3 direct_light(Surface s) {
  vec3 sum = vec3(0.0);
  for (uint i = 0u; i < frame.counts.x; ++i) {
    if (!reaches(lights[i], s.position)) continue;
    LightSample light = light_at(lights[i], s.position);
    if (dot(s.geometric, light.direction) <= 0.0) continue;
    sum += light.irradiance * shade_light(s.color, s.metallic, s.roughness, s.f0, s.normal, s.eye,
                                          light.direction);
  }
  return sum;
}

/// Split-sum with multiple scattering: what the single-scattering lobe loses comes back, so that
/// nothing is lost in a furnace (Fdez-Aguera 2019).
vec3 environment_light(Surface s, float occlusion) {
  float n_dot_v = clamp(dot(s.normal, s.eye), 1e-3, 1.0);
  vec2 split = textureLod(split_sum_table, vec2(n_dot_v, s.roughness), 0.0).rg;
  vec3 single = s.f0 * split.x + split.y;
  float missing = 1.0 - (split.x + split.y);
  vec3 average = s.f0 + (1.0 - s.f0) / 21.0;
  vec3 multiple = missing * single * average / (1.0 - average * missing);
  vec3 diffuse = (1.0 - s.metallic) * s.color * (1.0 - single - multiple);
  vec3 irradiance = environment_irradiance(s.normal);
  vec3 sum = vec3(0.0);
  if (enabled(frame_environment_diffuse)) sum += diffuse * irradiance * occlusion;
  if (enabled(frame_environment_specular)) {
    vec3 mirror = reflect(-s.eye, s.normal);
    sum += (single * environment_reflection(mirror, s.roughness) + multiple * irradiance) *
           occlusion;
  }
  return sum;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (outside_frame(pixel)) return;
  float view_z = imageLoad(motion, pixel).w;
  if (view_z <= 0.0) {
    imageStore(hdr, pixel, imageLoad(background, pixel));
    return;
  }
  vec4 encoded = imageLoad(normals, pixel);
  vec4 color = imageLoad(base_color, pixel);
  vec4 packed_surface = imageLoad(surface, pixel);
  Surface s;
  s.position = world_position(pixel, view_z);
  s.normal = octahedral_decode(encoded.xy);
  s.geometric = octahedral_decode(encoded.zw);
  s.eye = to_eye(pixel);
  s.color = color.rgb * color.rgb;
  s.roughness = packed_surface.x;
  s.metallic = packed_surface.y;
  s.f0 = mix(vec3(0.04), s.color, s.metallic);

  vec3 radiance = vec3(0.0);
  if (packed_surface.z > 0.5) {
    radiance = s.color;
  } else {
    if (enabled(frame_direct)) {
      float visible = enabled(frame_shadows) ? imageLoad(shadow_visibility, pixel).r : 1.0;
      radiance += direct_light(s) * visible;
    }
    float open = enabled(frame_ambient_occlusion) ? imageLoad(ambient_visibility, pixel).r : 1.0;
    radiance += environment_light(s, open * color.a);
  }
  if (enabled(frame_emissive)) radiance += imageLoad(emissive, pixel).rgb;
  // One bad pixel must not spread through the history.
  if (any(isnan(radiance)) || any(isinf(radiance))) radiance = vec3(0.0);
  imageStore(hdr, pixel, vec4(radiance, 1.0));
}
