#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// Draws the caps of section planes into the G-buffer: unlit, in a flat colour.
#include "lib/frame.glsl"
#include "lib/math/octahedral.glsl"
#include "lib/rays/section.glsl"

layout(set = 1, binding = 0, std430) readonly buffer Caps { uvec2 caps[]; };
layout(set = 1, binding = 1, rgba32f) writeonly uniform image2D normals;
layout(set = 1, binding = 2, rgba8) writeonly uniform image2D base_color;
layout(set = 1, binding = 3, rgba8) writeonly uniform image2D surface;
layout(set = 1, binding = 4, rgba32f) writeonly uniform image2D motion;
layout(set = 1, binding = 5, rgba16f) writeonly uniform image2D emissive;
layout(set = 1, binding = 6, rg32f) writeonly uniform image2D depth_slope;
layout(set = 1, binding = 7, r32ui) writeonly uniform uimage2D instance_id;

/// Where the ray through a pixel's sample meets the plane, world space.
vec3 point_on(vec4 plane, ivec2 pixel) {
  vec3 origin = enabled(frame_orthographic) ? world_position(pixel, 0.0) : frame.eye.xyz;
  vec3 direction = -to_eye(pixel);
  float rise = dot(plane.xyz, direction);
  float t = (plane.w - dot(plane.xyz, origin)) / (abs(rise) < 1e-6 ? 1e-6 : rise);
  return origin + t * direction;
}

float view_z_of(vec3 position) { return -(frame.view * vec4(position, 1.0)).z; }

vec4 motion_of(vec3 position, float view_z) {
  vec3 clip_now = (frame.unjittered * vec4(position, 1.0)).xyw;
  vec3 clip_before = (frame.previous_unjittered * vec4(position, 1.0)).xyw;
  float z_before = -(frame.previous_view * vec4(position, 1.0)).z;
  return vec4(clip_before.xy / clip_before.z * 0.5 - clip_now.xy / clip_now.z * 0.5,
              z_before - view_z, view_z);
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (outside_frame(pixel)) return;
  uvec2 cap = caps[uint(pixel.y) * frame.extent.x + uint(pixel.x)];
  if (cap.x == 0u) return;
  vec4 plane = section.planes[cap.x - 1u];
  vec3 position = point_on(plane, pixel);
  float view_z = view_z_of(position);
  vec2 slope = vec2(view_z_of(point_on(plane, pixel + ivec2(1, 0))),
                    view_z_of(point_on(plane, pixel + ivec2(0, 1)))) - view_z;
  vec2 normal = octahedral_encode(plane.xyz);
  imageStore(normals, pixel, vec4(normal, normal));
  imageStore(base_color, pixel, vec4(sqrt(section.cap_color), 1.0));
  imageStore(surface, pixel, vec4(1.0, 0.0, 1.0, 0.0));
  imageStore(motion, pixel, motion_of(position, view_z));
  imageStore(emissive, pixel, vec4(0.0, 0.0, 0.0, 1.0));
  imageStore(depth_slope, pixel, vec4(clamp(slope, -view_z, view_z), 0.0, 0.0));
  imageStore(instance_id, pixel, uvec4(cap.y));
}
