#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
// Changes what the G-buffer says of the surfaces that rays have met, as a shading mode shows them.
#include "lib/math/octahedral.glsl"
#include "lib/rays/ray_index.glsl"
#include "lib/scene/hit_surface.glsl"
#include "shared/shading.h"

layout(set = 1, binding = 0, std430) readonly buffer Count { RayCount ray_count; };
layout(set = 1, binding = 1, std430) readonly buffer Rays { Ray rays[]; };
layout(set = 1, binding = 2, std430) readonly buffer Hits { Hit hits[]; };
layout(set = 1, binding = 3, rgba32f) readonly uniform image2D normals;
layout(set = 1, binding = 4, rgba8) uniform image2D base_color;
layout(set = 1, binding = 5, rgba8) writeonly uniform image2D surface;
layout(set = 1, binding = 6, rgba16f) writeonly uniform image2D emissive;
layout(push_constant) uniform Constants { ShadingConstants shading; };

bool shows_edge(Ray ray, Hit hit) {
  HitTriangle t = load_triangle(hit);
  vec3 at = triangle_position(t);
  vec3 position = ray.origin + hit.t * ray.direction;
  float view_z = -(frame.view * vec4(position, 1.0)).z;
  return is_on_edge(transform_direction(t, t.a.position - at),
                    transform_direction(t, t.b.position - at),
                    transform_direction(t, t.c.position - at), ray.direction,
                    pixel_footprint(view_z));
}

void draw_edge(ivec2 pixel) {
  vec4 root = imageLoad(base_color, pixel);
  float brightness = dot(root.rgb * root.rgb, vec3(0.2126, 0.7152, 0.0722));
  float line = brightness < dark_surface ? bright_line : 0.0;
  imageStore(base_color, pixel, vec4(vec3(sqrt(line)), root.a));
  imageStore(emissive, pixel, vec4(0.0, 0.0, 0.0, 1.0));
}

/// Relative to the ray: x right, y up, z toward the eye.
vec3 seen_normal(vec3 normal, vec3 direction) {
  vec3 right = normalize(cross(frame.inverse_view[1].xyz, -direction));
  vec3 up = cross(-direction, right);
  return vec3(dot(normal, right), dot(normal, up), -dot(normal, direction));
}

vec3 flat_color(ivec2 pixel, Ray ray, Hit hit) {
  if (shading.mode == shading_uv_checker) {
    HitTriangle t = load_triangle(hit);
    return uv_checker_color(t.a.uv0 * t.weights.x + t.b.uv0 * t.weights.y + t.c.uv0 * t.weights.z);
  }
  vec3 normal = octahedral_decode(imageLoad(normals, pixel).xy);
  if (shading.mode == shading_matcap) return matcap_color(seen_normal(normal, ray.direction));
  vec3 shown = 0.5 * normal + 0.5;
  return shown * shown;  // about what a display needs
}

void store(ivec2 pixel, vec3 color, vec4 kind) {
  imageStore(base_color, pixel, vec4(sqrt(color), 1.0));
  imageStore(surface, pixel, kind);
  imageStore(emissive, pixel, vec4(0.0, 0.0, 0.0, 1.0));
}

void main() {
  uint index = ray_index();
  if (index >= ray_count.count) return;
  Hit hit = hits[index];
  if (hit.instance == hit_none) return;
  Ray ray = rays[index];
  ivec2 pixel = ivec2(ray.pixel & 0xffffu, ray.pixel >> 16u);
  if (shading.mode == shading_wireframe) {
    if (shows_edge(ray, hit)) draw_edge(pixel);
  } else if (shading.mode == shading_clay) {
    store(pixel, vec3(clay_albedo), vec4(clay_roughness, 0.0, 0.0, 0.0));
  } else {
    store(pixel, flat_color(pixel, ray, hit), vec4(1.0, 0.0, 1.0, 0.0));
  }
}
