// Half of a separable iteration of the a-trous filter for visibility and reflections at once, which
// differ in what keeps values apart and have the surfaces in common. Channels are shadow, ambient
// and the brightness of the reflection.
#include "lib/denoise/atrous_taps.glsl"
#include "lib/denoise/half_formats.glsl"
#include "lib/denoise/packed_guide.glsl"
#include "lib/math/luminance.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 1, binding = 0) uniform usampler2D guide;
layout(set = 1, binding = 1) uniform sampler2D depth_slope;  // in parts of view Z
layout(set = 1, binding = 2) uniform sampler2D visibility;
layout(set = 1, binding = 3) uniform sampler2D reflection;
layout(set = 1, binding = 4, FILTERED_FORMAT) writeonly uniform image2D filtered_visibility;
layout(set = 1, binding = 5, FILTERED_FORMAT) writeonly uniform image2D filtered_reflection;
layout(push_constant) uniform Constants {
  AtrousConstants constants;       // of visibility
  AtrousConstants for_reflection;  // other than those only in luminance_sigma and flags
};

struct Value {
  vec4 visibility;  // as visibility_signal.glsl
  vec4 reflection;  // as specular_signal.glsl
};
#define Channels vec3

const vec3 smallest_difference =
    vec3(smallest_visibility_difference.xx, smallest_radiance_difference);

vec3 brightness(Value value) { return vec3(value.visibility.xy, luminance(value.reflection.rgb)); }
vec3 variance_of(Value value) { return vec3(value.visibility.zw, value.reflection.w); }
Value with_variance(Value value, vec3 variance) {
  return Value(vec4(value.visibility.xy, variance.xy), vec4(value.reflection.rgb, variance.z));
}
vec3 signal_exponent(float common_part, float of_roughness) {
  return vec3(common_part, common_part, common_part + of_roughness);
}
vec3 weight_of_bits(vec3 bits) { return vec3(weight_of_bits(bits.xy), weight_of_bits(bits.z)); }

Value weighed(Value value, vec3 weight) {
  return Value(value.visibility * weight.xyxy, value.reflection * weight.z);
}
Value plus(Value a, Value b) {
  return Value(a.visibility + b.visibility, a.reflection + b.reflection);
}

Value load(ivec2 texel) {
  return Value(texelFetch(visibility, texel, 0), texelFetch(reflection, texel, 0));
}
void save(ivec2 texel, Value value) {
  imageStore(filtered_visibility, texel, value.visibility);
  imageStore(filtered_reflection, texel, value.reflection);
}
Value nearest_halves(Value value) {
  return Value(nearest_halves(value.visibility), nearest_halves(value.reflection));
}

vec3 luminance_sigmas() {
  return vec3(vec2(constants.luminance_sigma), for_reflection.luminance_sigma);
}
bvec3 keep_variance() {
  return bvec3(bvec2(has(constants, atrous_keep_variance)),
               has(for_reflection, atrous_keep_variance));
}
bool all_left(Guide p) { return is_left(constants, p) && is_left(for_reflection, p); }
/// One of the signals may be left as it is where the other is filtered.
Value where_left(Guide p, Value value, Value result) {
  return Value(is_left(constants, p) ? value.visibility : result.visibility,
               is_left(for_reflection, p) ? value.reflection : result.reflection);
}

#include "lib/denoise/atrous_half_pass.glsl"
