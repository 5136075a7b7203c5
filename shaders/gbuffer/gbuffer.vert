#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/frame.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec2 color_rg;
layout(location = 2) in vec3 normal;
layout(location = 3) in vec2 color_ba;
layout(location = 4) in vec4 tangent;
layout(location = 5) in vec4 uv;
layout(location = 6) in vec3 previous_position;

layout(location = 0) out vec3 world_normal;
layout(location = 1) out vec4 world_tangent;
layout(location = 2) out vec4 texture_uv;
layout(location = 3) out vec4 vertex_color;
layout(location = 4) out vec3 clip_now;
layout(location = 5) out vec3 clip_before;
layout(location = 6) out vec2 view_depths;  // now and one frame ago, metres along -Z
layout(location = 7) out vec3 world_point;

layout(push_constant) uniform Constants { DrawConstants draw; };

vec3 transform(vec4 rows[3], vec4 v) { return vec3(dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)); }

/// -1 where the instance's matrix changes the handedness. Not a condition: see
/// lib/scene/gbuffer_surface.glsl.
float orientation() { return 1.0 - 2.0 * float(min(draw.flags & instance_flipped, 1u)); }

/// Cofactors of the upper 3x3 times n: the inverse transpose's direction without dividing, turned
/// outward again where the matrix changes the handedness.
vec3 transform_normal(vec4 rows[3], vec3 n) {
  vec3 cofactors = vec3(dot(cross(rows[1].xyz, rows[2].xyz), n),
                        dot(cross(rows[2].xyz, rows[0].xyz), n),
                        dot(cross(rows[0].xyz, rows[1].xyz), n));
  return normalize(cofactors * orientation());
}

void main() {
  vec4 world = vec4(transform(draw.world, vec4(position, 1.0)), 1.0);
  vec4 before = vec4(transform(draw.previous_world, vec4(previous_position, 1.0)), 1.0);
  world_normal = transform_normal(draw.world, normal);
  world_tangent = vec4(transform(draw.world, vec4(tangent.xyz, 0.0)),
                       tangent.w * orientation());
  texture_uv = uv;
  vertex_color = vec4(color_rg, color_ba);
  clip_now = (frame.unjittered * world).xyw;
  clip_before = (frame.previous_unjittered * before).xyw;
  view_depths = vec2(-(frame.view * world).z, -(frame.previous_view * before).z);
  world_point = world.xyz;
  gl_Position = frame.view_projection * world;
}
