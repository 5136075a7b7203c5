#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// What the camera's ray met, lit along the hybrid's own paths: emission at once; a light, the
// environment's diffuse light and a specular ray, as far as these are not occluded.
#include "lib/rays/reference_path.glsl"
#include "lib/rays/specular_pixels.glsl"
#include "lib/rays/stored_rays.glsl"

layout(set = 1, binding = 0, std430) buffer Rays { Ray rays[]; };
layout(set = 1, binding = 1, std430) readonly buffer Hits { Hit hits[]; };
layout(set = 1, binding = 2, std430) buffer Paths { ReferencePath paths[]; };
layout(set = 1, binding = 3, std430) writeonly buffer ShadowCount { RayCount shadow_count; };
layout(set = 1, binding = 4, std430) writeonly buffer ShadowRays { StoredRay shadow_rays[]; };
layout(set = 1, binding = 5, std430) writeonly buffer AmbientCount { RayCount ambient_count; };
layout(set = 1, binding = 6, std430) writeonly buffer AmbientRays { StoredRay ambient_rays[]; };
layout(set = 1, binding = 7, std430) writeonly buffer MirrorCount { RayCount mirror_count; };
layout(set = 1, binding = 8, std430) writeonly buffer MirrorRays { StoredRay mirror_rays[]; };
layout(set = 1, binding = 9, rgba32f) uniform image2D reference;
layout(set = 1, binding = 10, std430) readonly buffer Shade { float ground_shade[]; };
layout(push_constant) uniform Constants { ReferenceConstants constants; };
#include "lib/lighting/ground.glsl"

Ray shadow_ray(SurfaceMaterial m, vec3 position, vec3 throughput, ivec2 pixel) {
  if (!enabled(frame_direct)) return no_ray();
  vec3 sum = vec3(0.0);
  for (uint i = 0u; i < frame.light_count; ++i) {
    if (light_reaches(i, position)) sum += light_contribution(light_number(i), m, position);
  }
  float pick = path_number(pixel, constants.round, 1u);
  LightChoice choice = choose_light(m, position, pick);
  if (choice.total <= 0.0) return no_ray();
  bool valid = false;
  Ray ray = light_ray(light_number(choice.number), m, position, 0.0,
                      path_pair(pixel, constants.round, 2u), pick, valid);
  if (!valid && enabled(frame_shadows)) return no_ray();
  // Light of all lights times visibility, estimated with one ray to a randomly chosen light.
  carry(ray, throughput * sum);
  if (!enabled(frame_shadows)) ray.t_max = 0.0;
  return ray;
}

/// `ambient` is the light that comes along it.
Ray ambient_ray(SurfaceMaterial m, vec3 position, vec3 ambient, ivec2 pixel) {
  vec3 direction = sample_cosine(m.normal, path_pair(pixel, constants.round, 3u));
  Ray ray = ray_from(position, m.geometric, direction, frame.ambient_radius);
  bool open = !enabled(frame_ambient_occlusion);
  if (open) ray.t_max = 0.0;
  if (open || dot(direction, m.geometric) > 0.0) carry(ray, ambient);
  return ray;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (outside_frame(pixel)) return;
  uint index = pixel_index(pixel);
  if (index == 0u) shadow_count = ambient_count = mirror_count = dense_stream(frame_blending());
  Ray ray = rays[index];
  if (!is_wanted(ray)) return;
  rays[index] = no_ray();
  Ray shadow = no_ray(), ambient = no_ray(), specular = no_ray();
  Hit hit = hits[index];
  vec3 radiance = vec3(0.0);
  ReferencePath path = paths[index];
  if (hit.instance == hit_none) {
    radiance = path.throughput * environment_background(ray.direction) *
               ground_factor(ray.origin, ray.direction);
  } else {
    RayCone cone = RayCone(path.cone_width, path.cone_spread);
    HitSurface s = hit_surface(hit, ray.direction, cone_width(cone, hit.t));
    SurfaceMaterial m = material_of(s, ray.direction);
    if (constants.round + 1u < constants.limit &&
        (is_open(s, ray.direction) ||
         passes_through(s, seen_behind(s, m), pixel, constants.round, path.throughput))) {
      rays[index] = beyond(ray, hit);
      paths[index] = path;
      return;
    }
    radiance = path.throughput * own_light(s);
    if (!is_unlit(s)) {
      shadow = shadow_ray(m, s.position, path.throughput, pixel);
      vec3 open = enabled(frame_environment_diffuse) ? environment_diffuse(m) : vec3(0.0);
      if (traces_specular(specular_roughness(m), constants.max_roughness)) {
        SpecularSample drawn = sample_specular(m, path_pair(pixel, constants.round, 4u));
        if (any(greaterThan(drawn.weight, vec3(0.0)))) {
          specular = ray_from(s.position, s.geometric, drawn.direction, 1e30);
        }
        RayCone cone_behind = reflected_cone(cone, hit.t, specular_roughness(m));
        paths[index] = ReferencePath(path.throughput * drawn.weight, 1u, cone_behind.width,
                                     cone_behind.spread, path_specular, 0.0);
      } else if (enabled(frame_environment_specular)) {
        open += environment_specular(m);
      }
      ambient = ambient_ray(m, s.position, path.throughput * open * s.occlusion, pixel);
    }
  }
  shadow_rays[index] = stored(shadow);
  ambient_rays[index] = stored(ambient);
  mirror_rays[index] = stored(specular);
  imageStore(reference, pixel, vec4(radiance, 1.0));
}
