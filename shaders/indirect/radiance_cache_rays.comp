#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
// Chooses the cells that are updated in this frame: a shadow ray toward one light, or one emissive
// triangle, and a gathering ray for each, and a probe for those that have moved. Frees those that
// nothing has used for long.
#include "lib/lighting/environment.glsl"
#include "lib/lighting/light_choice.glsl"
#include "lib/math/sampling.glsl"
#include "lib/rays/ray_stream.glsl"
#include "shared/emissive.h"
#include "shared/path_guide.h"
#include "shared/radiance_cache.h"

layout(set = 1, binding = 0, std430) buffer Keys { uint cache_keys[]; };
layout(set = 1, binding = 1, std430) buffer Cells { RadianceCell cells[]; };
layout(set = 1, binding = 2, std430) buffer Count { RayCount ray_count; };
layout(set = 1, binding = 3, std430) writeonly buffer Rays { StoredRay rays[]; };
layout(set = 1, binding = 4, std430) buffer ShadowCount { RayCount shadow_count; };
layout(set = 1, binding = 5, std430) writeonly buffer ShadowRays { StoredRay shadow_rays[]; };
// Of this frame, in scenes with emissive triangles.
layout(set = 1, binding = 6, std430) readonly buffer Points { EmissivePoint points[]; };
layout(set = 1, binding = 7, std430) readonly buffer Guide { GuideEntry guide[]; };
layout(push_constant) uniform Constants { RadianceCacheConstants constants; };
#include "lib/lighting/emissive_choice.glsl"
#include "lib/lighting/path_guide.glsl"
#include "lib/lighting/radiance_cache.glsl"

/// A white surface without specular lobes.
SurfaceMaterial white_surface(vec3 normal) {
  SurfaceMaterial m = surface_material(vec3(1.0), 0.0, 1.0, normal, normal, normal, plain_layer());
  m.f0 = m.f90_minus_f0 = m.specular_albedo = vec3(0.0);
  m.diffuse_albedo = vec3(1.0);
  return m;
}

float cell_number(uint check, uint which) {
  uvec3 hashed = pcg3d(uvec3(check, constants.frame_number, frame.seed * 16u + which));
  return float(hashed.x >> 8u) * exp2(-24.0);
}
vec2 cell_pair(uint check, uint which) {
  uvec3 hashed = pcg3d(uvec3(check, constants.frame_number, frame.seed * 16u + which));
  return vec2(hashed.xy >> 8u) * exp2(-24.0);
}

/// Rays that find a new cell before its maker has filled it know by its samples.
void free_cell(uint slot) {
  cache_keys[slot] = 0u;
  cells[slot].samples = cells[slot].state = 0u;
  cells[slot].direct = cells[slot].indirect = vec3(0.0);
}

uint counted_before(uint counts) {
  return cache_keys[counts + (constants.frame_number + 2u) % cache_counters];
}
/// For the next frame.
void count_cell(uint counts) {
  atomicAdd(cache_keys[counts + constants.frame_number % cache_counters], 1u);
}

uint idle_frames(RadianceCell cell) {
  return constants.frame_number - cell.last_used;
}

bool is_forgotten(RadianceCell cell) {
  bool crowded = counted_before(cache_counts) > cache_crowd;
  return idle_frames(cell) > (crowded ? cache_crowd_lifetime : cache_lifetime);
}

/// After a change of light: few, or none where nothing is about to update them.
uint remaining_samples(RadianceCell cell) {
  return min(cell.samples, idle_frames(cell) > cache_used_frames ? 0u : cache_new_samples);
}

/// Whether the cell is one of those that are updated.
bool is_due(RadianceCell cell, uint check) {
  count_cell(cache_counts);
  if (cell.state == cell_split || idle_frames(cell) > cache_used_frames) return false;
  count_cell(cache_used_counts);
  float probability = constants.updates / float(max(counted_before(cache_used_counts), 1u));
  if (cell.samples < cache_new_samples) probability *= cache_new_factor;
  return cell_number(check, 0u) < probability;
}

/// From where the cell was to where it is. @return whether it has moved
bool probe_of(RadianceCell cell, uint slot, out Ray ray) {
  if (cell.moved == 0u || cell.splits >= most_splits) return false;
  cells[slot].moved = 0u;
  vec3 end = raised(cell.position, cell.normal, cell.size);
  float far = distance(cell.anchor, end);
  ray.origin = cell.anchor;
  ray.t_min = 0.0;
  ray.direction = (end - cell.anchor) / max(far, 1e-30);
  ray.t_max = far;
  ray.pixel = slot;
  ray.user = probe_mark;
  ray.padding0 = ray.padding1 = 0u;
  return far > 0.0;
}

/// It carries what its light is multiplied by, and the density that it has without a guide.
Ray gathering_ray(RadianceCell cell, uint slot, uint check) {
  vec2 u = cell_pair(check, 1u);
  GuidedPair guided = GuidedPair(u, bin_of(u), 1.0);
  if (constants.guided != 0u) {
    guided = guided_pair_at(cell.position, cell.normal, u, constants.cell_angle,
                            constants.least_size);
  }
  cells[slot].bin = guided.bin;
  Ray ray;
  ray.origin = offset_origin(cell.position, cell.normal, 0.0);
  ray.t_min = 0.0;
  ray.direction = sample_cosine_by_axis(cell.normal, guided.u);
  ray.t_max = 1e30;
  ray.pixel = slot;
  ray.user = 0u;
  ray.padding0 = floatBitsToUint(guided.weight);
  ray.padding1 = floatBitsToUint(dot(ray.direction, cell.normal) / pi);
  return ray;
}

/// The shadow ray of a cell, which carries what arrives. @return whether there is one
bool light_of_cell(RadianceCell cell, uint slot, uint check, out Ray shadow) {
  SurfaceMaterial m = white_surface(cell.normal);
  LightChoice choice = LightChoice(0u, 0.0, 0.0);
  vec2 picks = cell_pair(check, 2u);
  float pick = picks.x;
  if (enabled(frame_direct)) choice = choose_light(m, cell.position, picks.y, pick);
  EmissiveChoice emissive = EmissiveChoice(vec3(0.0), 0.0, cell.normal, 0.0);
  if (scene_has(scene_emissive) && enabled(frame_emissive)) {
    vec2 u = cell_pair(check, 8u);
    emissive = choose_emissive(cell.position, cell.normal, cell.normal, u.x, u.y);
  }
  // One of both, in proportion to their light.
  float both = choice.total + emissive.total;
  if (both <= 0.0) return false;
  bool shines = cell_number(check, 9u) * both < emissive.total;
  bool lit = true;
  vec3 carried;
  if (shines) {
    shadow.origin = offset_origin(cell.position, cell.normal, 0.0);
    shadow.t_min = 0.0;
    shadow.direction = emissive.direction;
    shadow.t_max = emissive.distance * 0.999;
    carried = emissive.light * (both / emissive.total);
  } else {
    Light light = light_number(choice.number);
    shadow = light_ray(light, m, cell.position, 0.0, cell_pair(check, 3u), pick, lit);
    carried = light_contribution(light, m, cell.position) * (both / choice.weight);
    if (!enabled(frame_shadows)) shadow.t_max = 0.0;
  }
  shadow.pixel = slot | (shines ? cache_emissive_ray : 0u);
  shadow.user = floatBitsToUint(carried.r);
  shadow.padding0 = floatBitsToUint(carried.g);
  shadow.padding1 = floatBitsToUint(carried.b);
  return lit;
}

void main() {
  uint slot = gl_GlobalInvocationID.x;
  bool gathers = false, lit = false, probes = false;
  Ray ray, shadow, probe;
  if (constants.reset != 0u) {
    free_cell(slot);
    if (slot < cache_words - cache_cells) cache_keys[cache_cells + slot] = 0u;
  }
  uint check = cache_keys[slot];
  if (check != 0u) {
    RadianceCell cell = cells[slot];
    cells[slot].priority = 0u;
    if (cell.state != cell_split) cells[slot].state = cell_rests;
    if (constants.forget != 0u) cell.samples = cells[slot].samples = remaining_samples(cell);
    if (is_forgotten(cell)) {
      free_cell(slot);
    } else if (is_due(cell, check)) {
      gathers = true;
      probes = probe_of(cell, slot, probe);
      cells[slot].state = cell_updated;
      cells[slot].new_direct = cells[slot].new_indirect = vec3(0.0);
      ray = gathering_ray(cell, slot, check);
      lit = light_of_cell(cell, slot, check, shadow);
    }
  }
  APPEND_RAY(gathers, ray)
  barrier();
  APPEND_RAY(probes, probe)
  barrier();
  APPEND_RAY_TO(shadow_count, shadow_rays, lit, shadow)
}
