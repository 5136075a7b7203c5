#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// Begins one path per pixel.
#include "lib/rays/camera_ray.glsl"
#include "lib/rays/reference_path.glsl"
#include "lib/rays/stored_rays.glsl"

layout(set = 1, binding = 0, std430) writeonly buffer Count { RayCount ray_count; };
layout(set = 1, binding = 1, std430) writeonly buffer Rays { StoredRay rays[]; };
layout(set = 1, binding = 2, std430) writeonly buffer Paths { ReferencePath paths[]; };
layout(set = 1, binding = 3, rgba32f) writeonly uniform image2D reference;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (outside_frame(pixel)) return;
  if (pixel == ivec2(0)) ray_count = dense_stream(0u);
  RayCone cone = camera_cone();
  rays[pixel_index(pixel)] = stored(camera_ray(pixel));
  paths[pixel_index(pixel)] = ReferencePath(vec3(1.0), 0u, cone.width, cone.spread, 0u, 0.0);
  imageStore(reference, pixel, vec4(0.0, 0.0, 0.0, 1.0));
}
