#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// Rays that look for blended surfaces between the camera and what the G-buffer holds, and the
// images that accumulate them.
#include "lib/rays/camera_ray.glsl"
#include "lib/rays/ray_stream.glsl"

layout(set = 1, binding = 0, rgba32f) readonly uniform image2D motion;
layout(set = 1, binding = 1, std430) buffer Count { RayCount ray_count; };
layout(set = 1, binding = 2, std430) writeonly buffer Rays { StoredRay rays[]; };
layout(set = 1, binding = 3, rgba32f) writeonly uniform image2D radiance;
layout(set = 1, binding = 4, rgba32f) writeonly uniform image2D behind;
layout(set = 1, binding = 5, rgba32f) writeonly uniform image2D front_motion;
layout(set = 1, binding = 6, rgba8) writeonly uniform image2D surface;
layout(set = 1, binding = 7, rgba32f) writeonly uniform image2D mirrored;
layout(push_constant) uniform Constants { uvec4 region; };  // of pixels: first, behind the last

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  bool inside = !outside_frame(pixel);
  bool requested = inside && all(greaterThanEqual(pixel, ivec2(region.xy))) &&
                all(lessThan(pixel, ivec2(region.zw)));
  Ray ray;
  if (inside) {
    vec4 moved = imageLoad(motion, pixel);
    imageStore(radiance, pixel, vec4(0.0));
    imageStore(behind, pixel, vec4(1.0, 1.0, 1.0, 0.0));
    imageStore(front_motion, pixel, moved);
    imageStore(surface, pixel, vec4(0.0));
    imageStore(mirrored, pixel, vec4(0.0));
    ray = camera_ray(pixel);
    float stretch = enabled(frame_orthographic) ? 1.0 : length(view_position(pixel, 1.0));
    // Not the surface itself, whose depth has been rounded.
    if (moved.w > 0.0) ray.t_max = min(ray.t_max, moved.w * stretch * (1.0 - 1e-5));
  }
  APPEND_RAY(requested, ray)
}
