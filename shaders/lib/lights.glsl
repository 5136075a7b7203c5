// KHR_lights_punctual in world space.
#ifndef HELIOGRAPH_LIGHTS_GLSL
#define HELIOGRAPH_LIGHTS_GLSL
#include "lib/frame.glsl"

struct LightSample {
  vec3 direction;   // toward the light, unit length
  float distance;   // metres
  vec3 irradiance;  // on a surface facing the light, unshadowed
};

/// Whether any of the light arrives at `position`: cheap, so that loops skip what is far away.
bool reaches(Light light, vec3 position) {
  vec3 to_light = light.position - position;
  return light.type == light_directional || light.range <= 0.0 ||
         dot(to_light, to_light) < light.range * light.range;
}

LightSample light_at(Light light, vec3 position) {
  LightSample s;
  if (light.type == light_directional) {
    s.direction = -light.direction;
    s.distance = 1e30;
    s.irradiance = light.color;
    return s;
  }
  vec3 to_light = light.position - position;
  float squared = max(dot(to_light, to_light), 1e-8);
  s.distance = sqrt(squared);
  s.direction = to_light / s.distance;
  float attenuation = 1.0 / squared;
  if (light.range > 0.0) {
    float q = squared / (light.range * light.range);
    float window = clamp(1.0 - q * q, 0.0, 1.0);
    attenuation *= window;
  }
  if (light.type == light_spot) {
    float cone = clamp(dot(light.direction, -s.direction) * light.spot_scale + light.spot_offset,
                       0.0, 1.0);
    attenuation *= cone * cone;
  }
  s.irradiance = light.color * attenuation;
  return s;
}

float luminance(vec3 color) { return dot(color, vec3(0.2126, 0.7152, 0.0722)); }

#endif
