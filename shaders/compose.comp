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

vec3 direct_light(SurfaceMaterial m, vec3 position) {
  vec3 sum = vec3(0.0);
  for (uint i = 0u; i < frame.counts.x; ++i) {
    if (!reaches(lights[i], position)) continue;
    LightSample light = light_at(lights[i], position);
    if (dot(m.geometric, light.direction) <= 0.0) continue;
    sum += light.irradiance * shade_light(m, light.direction);
  }
  return sum;
}

vec3 environment_light(SurfaceMaterial m) {
  vec3 sum = vec3(0.0);
  if (enabled(frame_environment_diffuse)) sum += environment_diffuse(m);
  if (enabled(frame_environment_specular)) sum += environment_specular(m);
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
  vec3 linear_color = color.rgb * color.rgb;
  SurfaceMaterial m = surface_material(linear_color, packed_surface.y, packed_surface.x,
                                       octahedral_decode(encoded.xy),
                                       octahedral_decode(encoded.zw), to_eye(pixel));

  vec3 radiance = vec3(0.0);
  if (packed_surface.z > 0.5) {
    radiance = linear_color;
  } else {
    if (enabled(frame_direct)) {
      float visible = enabled(frame_shadows) ? imageLoad(shadow_visibility, pixel).r : 1.0;
      radiance += direct_light(m, world_position(pixel, view_z)) * visible;
    }
    float open = enabled(frame_ambient_occlusion) ? imageLoad(ambient_visibility, pixel).r : 1.0;
    radiance += environment_light(m) * (open * color.a);
  }
  if (enabled(frame_emissive)) radiance += imageLoad(emissive, pixel).rgb;
  // One bad pixel must not spread through the history.
  if (any(isnan(radiance)) || any(isinf(radiance))) radiance = vec3(0.0);
  imageStore(hdr, pixel, vec4(radiance, 1.0));
}
