// Directions in proportion to the environment's luminance (server/render/resources/environment/environment_table.hpp).
#ifndef HELIOGRAPH_ENVIRONMENT_SAMPLING_GLSL
#define HELIOGRAPH_ENVIRONMENT_SAMPLING_GLSL
#include "lib/lighting/environment.glsl"

struct EnvironmentSample {
  vec3 direction;  // world, unit length
  float density;   // per steradian
};

/// Cells around the equator; half as many from pole to pole.
uint environment_grid_width() {
  return uint(sqrt(2.0 * float(textureSize(environment_cells))) + 0.5);
}

/// Draws a cell by `pick` and a point of it, uniform over its solid angle, by `within`.
EnvironmentSample sample_environment(vec2 pick, vec2 within) {
  uint width = environment_grid_width();
  uint count = width * width / 2u;
  uint cell = min(uint(pick.x * float(count)), count - 1u);
  uvec4 entry = texelFetch(environment_cells, int(cell));
  bool stays = pick.y < uintBitsToFloat(entry.x);
  cell = stays ? cell : entry.y;
  float azimuth = (float(cell % width) + within.x) / float(width) * 2.0 * pi - pi;
  float step_angle = 2.0 * pi / float(width);
  float top = float(cell / width) * step_angle;
  float cosine = mix(cos(top), cos(top + step_angle), within.y);
  float sine = sqrt(max(0.0, 1.0 - cosine * cosine));
  vec3 direction = vec3(sine * cos(azimuth), cosine, sine * sin(azimuth));
  return EnvironmentSample(world_of_environment(direction),
                           uintBitsToFloat(stays ? entry.z : entry.w));
}

/// Density of sample_environment() in a world direction, per steradian.
float environment_density(vec3 world) {
  uint width = environment_grid_width();
  vec2 uv = equirectangular_uv(environment_direction(world));
  uvec2 cell = min(uvec2(uv * vec2(width, width / 2u)), uvec2(width, width / 2u) - 1u);
  return uintBitsToFloat(texelFetch(environment_cells, int(cell.y * width + cell.x)).z);
}

#endif
