#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// Blends the frame with the mean of its samples; exposure, tone map and sRGB encoding with a
// triangular dither of one code value against bands.
#include "lib/frame.glsl"
#include "lib/math/random.glsl"
#include "lib/math/tone_map.glsl"
#include "shared/exposure.h"

layout(set = 1, binding = 0) uniform sampler2D radiance;
layout(set = 1, binding = 1, rgba16f) readonly uniform image2D mean;
layout(set = 1, binding = 2, r32f) readonly uniform image2D mean_weight;  // of `mean`
layout(set = 1, binding = 3, std140) uniform ExposureBlock { ExposureState exposure; };
layout(set = 1, binding = 4, rgba8) writeonly uniform image2D shown;
layout(push_constant) uniform Constants {
  uvec2 shown_size;      // of the frame that is shown, pixels
  uvec2 drawn;           // of `radiance`, whose nearest pixels are shown
  float uniform_weight;  // of `mean` in all pixels; below 0: that of `mean_weight`
};

vec3 tone_map(vec3 color) {
  switch (int(frame.tone_map_curve)) {
    case 0: return tone_map_neutral(color);
    case 1: return tone_map_aces(color);
    case 2: return tone_map_agx(color);
    default: return clamp(color, 0.0, 1.0);
  }
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(uvec2(pixel), shown_size))) return;
  ivec2 nearest = ivec2((2u * uvec2(pixel) + 1u) * drawn / (2u * shown_size));
  float weight = uniform_weight < 0.0 ? imageLoad(mean_weight, pixel).r : uniform_weight;
  vec3 color = weight < 1.0 ? texelFetch(radiance, nearest, 0).rgb : vec3(0.0);
  if (weight > 0.0) color = mix(color, imageLoad(mean, pixel).rgb, weight);
  color = max(color, 0.0) * exposure.factor;
  vec3 encoded = srgb_encode(tone_map(color));
  // The same noise in every frame, so that a converged frame does not change.
  vec2 noise = random_pair(uvec2(pixel), 0u, 5u, 0u);
  encoded += (noise.x - noise.y) / 255.0 * 0.5;
  imageStore(shown, pixel, vec4(encoded, 1.0));
}
