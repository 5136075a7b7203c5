#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/denoise/visibility_signal.glsl"
#include "lib/denoise/spatial_variance.glsl"
#include "lib/denoise/history_texels.glsl"

layout(set = 1, binding = 5, rgba16) writeonly uniform image2D kept;

void keep(ivec2 pixel, vec4 value) {
  imageStore(kept, pixel, as_fractions(value, rounding_of(pixel, frame.sample_index)));
}
