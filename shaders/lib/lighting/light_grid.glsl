// The lights that count where a surface lies: entries of its cell in the grid (shared/light_grid.h),
// each by one of its lights, drawn by intensity, and those outside of the grid.
#ifndef HELIOGRAPH_LIGHT_GRID_GLSL
#define HELIOGRAPH_LIGHT_GRID_GLSL
#include "lib/lighting/lights.glsl"
#include "shared/light_grid.h"

bool uses_light_grid() { return scene_has(scene_light_grid) && enabled(frame_light_grid); }

/// What of a grid a receiver reads: texels of the lights' table.
struct CellLights {
  int first_entry;
  int first_slot;
  int first_outside;
  uint outside;  // how many; the environment's sun is one more
};

CellLights cell_lights(vec3 position) {
  uint sun = frame.sun_radius >= 0.0 ? 1u : 0u;
  int header = int(max(frame.light_count - sun, uniform_lights) * texels_per_light);
  vec4 place = uintBitsToFloat(texelFetch(light_texels, header));
  uvec3 cells = texelFetch(light_texels, header + 1).xyz;
  uvec4 first = texelFetch(light_texels, header + 2);
  vec3 cell = floor((position - place.xyz) * place.w);
  uint list = cells.x * cells.y * cells.z;
  if (all(greaterThanEqual(cell, vec3(0.0))) && all(lessThan(cell, vec3(cells)))) {
    uvec3 at = uvec3(cell);
    list = (at.z * cells.y + at.y) * cells.x + at.x;
  }
  return CellLights(int(first.x + list * most_light_entries), int(first.y), int(first.z), first.w);
}

/// Lights outside of the grid.
uint outside_count(CellLights cell) {
  return cell.outside + (frame.sun_radius >= 0.0 ? 1u : 0u);
}
uint outside_light(CellLights cell, uint i) {
  if (i == cell.outside) return frame.light_count - 1u;
  return texelFetch(light_texels, cell.first_outside + int(i)).x;
}

/// The light that stands for an entry.
struct EntryLight {
  uint number;
  float weight;  // of its light; 0: there is no such entry, nor one after it
};

/// `picks` in [0, 1) decides.
EntryLight entry_light(CellLights cell, uint i, float picks) {
  if (i >= most_light_entries) return EntryLight(0u, 0.0);
  uvec4 entry = texelFetch(light_texels, cell.first_entry + int(i));
  if (entry.y == 0u) return EntryLight(0u, 0.0);
  if (entry.z != no_single_light) return EntryLight(entry.z, 1.0);
  float slots = float(entry.y);
  uint step = uint(min(fract(picks + float(i) * light_pick_step) * slots, slots - 1.0));
  uvec4 slot = texelFetch(light_texels, cell.first_slot + int(entry.x + step));
  return EntryLight(slot.x, uintBitsToFloat(slot.y) * slots);
}

/// Light that a surface sends to the eye from all lights, unshadowed. `picks` in [0, 1).
vec3 direct_light(SurfaceMaterial m, vec3 position, float picks) {
  if (!uses_light_grid()) return direct_light(m, position);
  CellLights cell = cell_lights(position);
  vec3 sum = vec3(0.0);
  for (uint i = 0u; i < outside_count(cell); ++i) {
    uint number = outside_light(cell, i);
    if (light_reaches(number, position)) sum += light_contribution(light_number(number), m, position);
  }
  EntryLight entry = entry_light(cell, 0u, picks);
  for (uint i = 1u; entry.weight > 0.0; entry = entry_light(cell, i++, picks)) {
    if (!light_reaches(entry.number, position)) continue;
    sum += light_contribution(light_number(entry.number), m, position) * entry.weight;
  }
  return sum;
}

#endif
