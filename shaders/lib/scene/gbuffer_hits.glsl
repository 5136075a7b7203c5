// The G-buffer from camera rays instead of triangles: the surfaces that rays have met, with the
// same signals as lib/scene/gbuffer_surface.glsl. Rays go on through back faces that are not drawn
// and through blended surfaces. GBUFFER_LAYERED: with what extensions add to materials. Bindings 0
// to 2, 4 and 5 of the pass set, and those from 14 on, are the pass's own.
#ifndef HELIOGRAPH_GBUFFER_HITS_GLSL
#define HELIOGRAPH_GBUFFER_HITS_GLSL
#include "lib/scene/coverage.glsl"
#include "lib/math/octahedral.glsl"

layout(set = 1, binding = 3, std430) readonly buffer Before { Vertex previous_vertices[]; };
layout(set = 1, binding = 6, rgba32f) writeonly uniform image2D normals;
layout(set = 1, binding = 7, rgba8) writeonly uniform image2D base_color;
layout(set = 1, binding = 8, rgba8) writeonly uniform image2D surface;
layout(set = 1, binding = 9, rgba32f) writeonly uniform image2D motion;
layout(set = 1, binding = 10, rgba16f) writeonly uniform image2D emissive;
layout(set = 1, binding = 11, rg32f) writeonly uniform image2D depth_slope;
layout(set = 1, binding = 12, r32ui) writeonly uniform uimage2D instance_id;
#ifdef GBUFFER_LAYERED
layout(set = 1, binding = 13, rgba32ui) writeonly uniform uimage2D surface_layers;
#endif

#include "lib/scene/hit_motion.glsl"

HitSurface met_surface(Ray ray, Hit hit) {
  return hit_surface(hit, ray.direction, cone_width(camera_cone(), hit.t));
}

/// Whether the ray goes on, unless this is its last round.
bool passes(Ray ray, HitSurface s) { return is_open(s, ray.direction) || is_blended(s); }

ivec2 pixel_of(Ray ray) { return ivec2(ray.pixel & 0xffffu, ray.pixel >> 16u); }

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

void store(ivec2 pixel, Hit hit, HitSurface s) {
  float view_z = -(frame.view * vec4(s.position, 1.0)).z;
  imageStore(normals, pixel, vec4(octahedral_encode(s.normal), octahedral_encode(s.geometric)));
  imageStore(base_color, pixel, vec4(sqrt(s.base_color), s.occlusion));
  float unlit = (s.flags & material_unlit) != 0u ? 1.0 : 0.0;
  float roughness = s.roughness;
  float through = 0.0;
#ifdef GBUFFER_LAYERED
  imageStore(surface_layers, pixel, pack_layer(s.layer, roughness, s.normal));
  roughness = smoother_roughness(s.layer, roughness);
  through = s.layer.diffuse_transmission;
#endif
  imageStore(surface, pixel, vec4(roughness, s.metallic, unlit, through));
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

#endif
