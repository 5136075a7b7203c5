#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
// The G-buffer from camera rays instead of triangles: the surfaces that rays have met, with the same
// signals as lib/gbuffer_surface.glsl. Rays go on through back faces that are not drawn and through
// the share of samples that a blended surface does not cover.
#include "lib/coverage.glsl"
#include "lib/octahedral.glsl"
#include "lib/random.glsl"
#include "lib/ray_index.glsl"
#include "lib/ray_stream.glsl"

layout(set = 1, binding = 0, std430) readonly buffer MetCount { RayCount met_count; };
layout(set = 1, binding = 1, std430) readonly buffer MetRays { Ray met_rays[]; };
layout(set = 1, binding = 2, std430) readonly buffer Hits { Hit hits[]; };
layout(set = 1, binding = 3, std430) readonly buffer Before { Vertex previous_vertices[]; };
layout(set = 1, binding = 4, std430) buffer Count { RayCount ray_count; };
layout(set = 1, binding = 5, std430) writeonly buffer Rays { Ray rays[]; };
layout(set = 1, binding = 6, rgba32f) writeonly uniform image2D normals;
layout(set = 1, binding = 7, rgba8) writeonly uniform image2D base_color;
layout(set = 1, binding = 8, rgba8) writeonly uniform image2D surface;
layout(set = 1, binding = 9, rgba32f) writeonly uniform image2D motion;
layout(set = 1, binding = 10, rgba16f) writeonly uniform image2D emissive;
layout(set = 1, binding = 11, rg32f) writeonly uniform image2D depth_slope;
layout(set = 1, binding = 12, r32ui) writeonly uniform uimage2D instance_id;
layout(push_constant) uniform Constants { uint last_round; };

bool passes(Ray ray, Hit hit, HitSurface s) {
  if (last_round != 0u) return false;
  if (is_open(s, ray.direction)) return true;
  if (!is_blended(s)) return false;
  uvec2 pixel = uvec2(ray.pixel & 0xffffu, ray.pixel >> 16u);
  return s.alpha < random_number(pixel, frame.extent.z, 40u + (hit.instance & 15u), frame.extent.w);
}

/// Change of view Z from this pixel to its neighbours on the surface's plane.
vec2 plane_slope(ivec2 pixel, HitSurface s, float view_z) {
  vec3 n = transpose(mat3(frame.inverse_view)) * s.geometric;
  vec3 at = view_position(pixel, view_z);
  vec2 slopes;
  for (int axis = 0; axis < 2; ++axis) {
    ivec2 beside = pixel + ivec2(axis == 0 ? 1 : 0, axis == 1 ? 1 : 0);
    vec3 through = view_position(beside, 1.0);
    if (enabled(frame_orthographic)) {
      vec3 across = through - vec3(at.xy, through.z);
      slopes[axis] = dot(n.xy, across.xy) / (abs(n.z) < 1e-4 ? 1e-4 : n.z);
    } else {
      float along = dot(n, through);
      float other = dot(n, at) / (abs(along) < 1e-6 ? 1e-6 : along);
      slopes[axis] = clamp(other - view_z, -view_z, view_z);
    }
  }
  return slopes;
}

/// Where the point of the triangle was in its mesh one frame ago.
vec3 previous_local(Hit hit, HitSurface s) {
  if (!scene_has(scene_deforms)) return s.local;
  uint base = instances[hit.instance].previous_vertex;
  if (base == 0u) return s.local;
  uint first = meshes[instances[hit.instance].mesh].first_index + 3u * hit.triangle;
  vec3 a = previous_vertices[base - 1u + indices[first]].position;
  vec3 b = previous_vertices[base - 1u + indices[first + 1u]].position;
  vec3 c = previous_vertices[base - 1u + indices[first + 2u]].position;
  return a * (1.0 - hit.u - hit.v) + b * hit.u + c * hit.v;
}

vec4 motion_of(Hit hit, HitSurface s, float view_z) {
  mat3x4 before = mat3x4(transpose(instances[hit.instance].previous_world));
  vec4 previous = vec4(vec4(previous_local(hit, s), 1.0) * before, 1.0);
  vec3 clip_now = (frame.unjittered * vec4(s.position, 1.0)).xyw;
  vec3 clip_before = (frame.previous_unjittered * previous).xyw;
  float z_before = -(frame.previous_view * previous).z;
  return vec4(clip_before.xy / clip_before.z * 0.5 - clip_now.xy / clip_now.z * 0.5,
              z_before - view_z, view_z);
}

void store(ivec2 pixel, Hit hit, HitSurface s) {
  float view_z = -(frame.view * vec4(s.position, 1.0)).z;
  imageStore(normals, pixel, vec4(octahedral_encode(s.normal), octahedral_encode(s.geometric)));
  imageStore(base_color, pixel, vec4(sqrt(s.base_color), s.occlusion));
  vec2 rough = vec2(s.roughness, 0.0);  // of what mirrors the sharper image; under the coat
  if (scene_has(scene_layers) && (s.flags & material_coated) != 0u) {
    rough = vec2(min(s.roughness, layers[s.layer].coat_roughness), s.roughness * (254.0 / 255.0));
  }
  float unlit = (s.flags & material_unlit) != 0u ? 1.0 : 0.0;
  imageStore(surface, pixel,
             vec4(rough.x, s.metallic, max(unlit, rough.y), float(s.layer) / 255.0));
  imageStore(motion, pixel, motion_of(hit, s, view_z));
  imageStore(emissive, pixel, vec4(s.emissive, 1.0));
  imageStore(depth_slope, pixel, vec4(plane_slope(pixel, s, view_z), 0.0, 0.0));
  imageStore(instance_id, pixel, uvec4(hit.instance + 1u));
}

void store_nothing(ivec2 pixel) {
  imageStore(normals, pixel, vec4(2.0));  // beyond the octahedron: no normal
  imageStore(base_color, pixel, vec4(0.0));
  imageStore(surface, pixel, vec4(0.0));
  imageStore(motion, pixel, vec4(0.0));
  imageStore(emissive, pixel, vec4(0.0));
  imageStore(depth_slope, pixel, vec4(0.0));
  imageStore(instance_id, pixel, uvec4(0u));
}

void main() {
  uint index = ray_index();
  bool goes_on = false;
  Ray ray;
  if (index < met_count.count) {
    ray = met_rays[index];
    Hit hit = hits[index];
    ivec2 pixel = ivec2(ray.pixel & 0xffffu, ray.pixel >> 16u);
    if (hit.instance == hit_none) {
      if (!outside_frame(pixel)) store_nothing(pixel);
    } else {
      HitSurface s = hit_surface(hit, ray.direction, cone_width(camera_cone(), hit.t));
      goes_on = passes(ray, hit, s);
      if (!goes_on) store(pixel, hit, s);
      ray = beyond(ray, hit);
    }
  }
  APPEND_RAY(goes_on, ray)
}
