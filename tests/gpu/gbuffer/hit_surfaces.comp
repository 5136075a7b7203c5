#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
// The surface that every camera ray hits, in the encoding of the G-buffer.
#include "lib/rays/camera_ray.glsl"
#include "lib/scene/hit_surface.glsl"
#include "lib/math/octahedral.glsl"

layout(set = 1, binding = 0, std430) readonly buffer Rays { Ray rays[]; };
layout(set = 1, binding = 1, std430) readonly buffer Hits { Hit hits[]; };
layout(set = 1, binding = 2, rgba32f) writeonly uniform image2D normals;
layout(set = 1, binding = 3, rgba32f) writeonly uniform image2D base_color;
layout(set = 1, binding = 4, rgba32f) writeonly uniform image2D surface;
layout(set = 1, binding = 5, rgba32f) writeonly uniform image2D emissive;
layout(set = 1, binding = 6, rgba32f) writeonly uniform image2D place;

void main() {
  uint index = gl_GlobalInvocationID.x;
  if (index >= frame.extent.x * frame.extent.y) return;
  Hit hit = hits[index];
  if (hit.instance == hit_none) return;
  Ray ray = rays[index];
  ivec2 pixel = ivec2(ray.pixel & 0xffffu, ray.pixel >> 16u);
  HitSurface s = hit_surface(hit, ray.direction, cone_width(camera_cone(), hit.t));
  imageStore(normals, pixel, vec4(octahedral_encode(s.normal), octahedral_encode(s.geometric)));
  imageStore(base_color, pixel, vec4(sqrt(s.base_color), s.occlusion));
  imageStore(surface, pixel, vec4(s.roughness, s.metallic,
                                  (s.flags & material_unlit) != 0u ? 1.0 : 0.0, 0.0));
  imageStore(emissive, pixel, vec4(s.emissive, 1.0));
  imageStore(place, pixel, vec4(s.position, float(hit.instance + 1u)));
}
