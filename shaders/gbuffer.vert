#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/frame.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec2 color_rg;
layout(location = 2) in vec3 normal;
layout(location = 3) in vec2 color_ba;
layout(location = 4) in vec4 tangent;
layout(location = 5) in vec4 uv;

layout(location = 0) out vec3 world_normal;
layout(location = 1) out vec4 world_tangent;
layout(location = 2) out vec4 texture_uv;
layout(location = 3) out vec4 vertex_color;
layout(location = 4) out vec3 clip_now;
layout(location = 5) out vec3 clip_before;
layout(location = 6) out vec2 view_depths;  // now and one frame ago, metres along -Z
layout(location = 7) out vec3 world_point;
layout(location = 8) flat out uint instance_index;

void main() {
  instance_index = gl_InstanceIndex;
  Instance instance = instances[gl_InstanceIndex];
  vec4 world = instance.world * vec4(position, 1.0);
  vec4 before = instance.previous_world * vec4(position, 1.0);
  world_normal = mat3(instance.normal_matrix) * normal;
  world_tangent = vec4(mat3(instance.world) * tangent.xyz,
                       (instance.flags & instance_flipped) != 0u ? -tangent.w : tangent.w);
  texture_uv = uv;
  vertex_color = vec4(color_rg, color_ba);
  clip_now = (frame.unjittered * world).xyw;
  clip_before = (frame.previous_unjittered * before).xyw;
  view_depths = vec2(-(frame.view * world).z, -(frame.previous_view * before).z);
  world_point = world.xyz;
  gl_Position = frame.view_projection * world;
}
