#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
// Rays from the chosen blended surface of each pixel, where it bends or blurs what is behind: into
// the volume that it encloses, or through the thin wall that it is. Each carries what its light is
// multiplied by.
#include "lib/scene/hit_material.glsl"
#include "lib/lighting/transmission.glsl"
#include "lib/math/random.glsl"
#include "lib/rays/ray_index.glsl"
#include "lib/rays/ray_stream.glsl"

layout(set = 1, binding = 0, std430) readonly buffer LitCount { RayCount lit_count; };
layout(set = 1, binding = 1, std430) readonly buffer LitRays { Ray lit_rays[]; };
layout(set = 1, binding = 2, std430) readonly buffer Chosen { Hit chosen[]; };
layout(set = 1, binding = 3, rgba32f) readonly uniform image2D radiance;  // a: all weights
layout(set = 1, binding = 4, rgba32f) readonly uniform image2D behind;    // a: the chosen one's
layout(set = 1, binding = 5, std430) buffer InsideCount { RayCount inside_count; };
layout(set = 1, binding = 6, std430) writeonly buffer InsideRays { StoredRay inside_rays[]; };
layout(set = 1, binding = 7, std430) buffer RefractedCount { RayCount refracted_count; };
layout(set = 1, binding = 8, std430) writeonly buffer RefractedRays { StoredRay refracted_rays[]; };

Ray through_ray(HitSurface s, SurfaceMaterial m, uint medium, vec3 throughput, ivec2 pixel) {
  vec3 light = throughput * m.transmitted;
  float index = 0.0;
  if (medium != 0u) {
    uint band = pixel_band(medium, pixel);
    index = refraction_index(medium, band);
    if (band != 0u) light *= 3.0 * vec3(equal(uvec3(1u, 2u, 3u), uvec3(band)));
  }
  vec2 u = random_pair(uvec2(pixel), frame.sample_index, entry_dimension, frame.seed);
  vec3 direction = sample_transmitted(m, index, u);
  float view_z = -(frame.view * vec4(s.position, 1.0)).z;
  uvec3 bits = floatBitsToUint(light);
  return Ray(offset_origin(s.position, -s.geometric, view_z), 0.0, direction, 1e30,
             uint(pixel.x) | uint(pixel.y) << 16u, bits.r, bits.g, bits.b);
}

void main() {
  uint index = ray_index();
  bool enters = false, passes = false;
  Ray through;
  if (index < lit_count.count) {
    Ray view = lit_rays[index];
    ivec2 pixel = ivec2(view.pixel & 0xffffu, view.pixel >> 16u);
    Hit hit = chosen[uint(pixel.y) * frame.extent.x + uint(pixel.x)];
    vec3 throughput = uintBitsToFloat(uvec3(hit.padding0, hit.padding1, hit.padding2)) *
                      (imageLoad(radiance, pixel).a / imageLoad(behind, pixel).a);
    HitSurface s = hit_surface(hit, view.direction, cone_width(camera_cone(), hit.t));
    Boundary boundary = boundary_of(hit, s, view.direction);
    if (bends_light(s, boundary)) {
      // Volumes attenuate light along its way through them.
      s.layer.transmitted = vec3(s.layer.transmission);
      SurfaceMaterial m = material_of(s, view.direction);
      through = through_ray(s, m, boundary.medium, throughput, pixel);
      bool carries = m.transmitted != vec3(0.0);
      enters = carries && boundary.medium != 0u;
      passes = carries && boundary.medium == 0u;
    }
  }
  APPEND_RAY_TO(inside_count, inside_rays, enters, through)
  APPEND_RAY_TO(refracted_count, refracted_rays, passes, through)
}
