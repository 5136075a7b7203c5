// Half of a separable iteration of the a-trous filter for one signal. What the signal is comes from
// the shader that includes this.
#include "lib/denoise/atrous_taps.glsl"
#include "lib/denoise/half_formats.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 1, binding = 0) uniform usampler2D guide;
layout(set = 1, binding = 1) uniform sampler2D depth_slope;  // in parts of view Z
layout(set = 1, binding = 2) uniform sampler2D signal;
layout(set = 1, binding = 3, FILTERED_FORMAT) writeonly uniform image2D filtered;
layout(push_constant) uniform Constants { AtrousConstants constants; };

#define Value vec4
#define Channels vec2

Value load(ivec2 texel) { return texelFetch(signal, texel, 0); }
void save(ivec2 texel, Value value) { imageStore(filtered, texel, value); }
Value weighed(Value value, Channels weight) { return value * weighing(weight); }
Value plus(Value a, Value b) { return a + b; }

Channels luminance_sigmas() { return Channels(constants.luminance_sigma); }
bvec2 keep_variance() { return bvec2(has(constants, atrous_keep_variance)); }
bool all_left(Guide p) { return is_left(constants, p); }
Value where_left(Guide p, Value value, Value result) { return result; }

#include "lib/denoise/atrous_half_pass.glsl"
