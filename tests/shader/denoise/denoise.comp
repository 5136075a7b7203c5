#version 460
#extension GL_GOOGLE_include_directive : require
#include "tests/shader/harness.glsl"
#include "lib/denoise/edge_stopping.glsl"
#include "lib/denoise/moments.glsl"
#include "lib/denoise/rectification.glsl"
#include "lib/denoise/reinhard.glsl"
#include "lib/denoise/reprojection.glsl"

vec4 weight(float exponent) { return vec4(exp(exponent)); }

ShaderOutput evaluate(uint which, ShaderInput given) {
  switch (which) {
    case 0: {
      // a: z, slope, curve; b: neighbour's z, offset, footprint; c: sigma.
      float away = plane_distance(given.a.x, given.a.yz, given.a.w, given.b.x, given.b.yz);
      float allowance = depth_allowance(given.a.yz, given.b.yz, given.b.w);
      return ShaderOutput(weight(depth_exponent(away, allowance, given.c.x)), vec4(away));
    }
    case 1: return ShaderOutput(weight(normal_exponent(given.a.x, given.a.y)), vec4(0.0));
    case 2: return ShaderOutput(exp(luminance_exponent(given.a.xy, given.a.zw, given.b.xy, given.b.z,
                                                       given.b.w)).xyxy, vec4(0.0));
    case 3: return ShaderOutput(weight(roughness_exponent(given.a.x, given.a.y)), vec4(0.0));
    case 4: {
      // a: position; b: bits.
      HistoryTaps taps = valid_taps(bilinear_taps(given.a.xy), uint(given.b.x));
      return ShaderOutput(taps.weights, vec4(vec2(taps.base), 0.0, 0.0));
    }
    case 5: return ShaderOutput(vec4(same_depth(given.a.x, given.a.y, given.a.zw, given.b.x,
                                                given.b.y)), vec4(0.0));
    case 6: return ShaderOutput(vec4(same_normal(given.a.xyz, given.b.xyz, given.a.w, given.b.w)),
                                vec4(0.0));
    case 7: return ShaderOutput(vec4(reinhard(given.a.rgb, given.a.w), 0.0),
                                vec4(inverse_reinhard(reinhard(given.a.rgb, given.a.w), given.a.w),
                                     0.0));
    case 8: return ShaderOutput(vec4(paper_inverse_reinhard(reinhard(given.a.rgb, given.a.w), 1.0),
                                     0.0), vec4(0.0));
    case 9: {
      // a: low; b: high; c: colour.
      Box box = Box(given.a.xyz, given.b.xyz);
      return ShaderOutput(vec4(clamp_to(box, given.c.xyz), 0.0), vec4(clip_to(box, given.c.xyz), 0.0));
    }
    case 10: return ShaderOutput(vec4(from_ycocg(to_ycocg(given.a.rgb)), 0.0),
                                 vec4(to_ycocg(given.a.rgb), 0.0));
    case 11: {
      // a, b, c: colours; d.x: scale.
      Window window = empty_window();
      add(window, given.a.xyz);
      add(window, given.b.xyz);
      add(window, given.c.xyz);
      Box box = variance_box(window, given.d.x);
      return ShaderOutput(vec4(box.low, 0.0), vec4(box.high, 0.0));
    }
    case 12: return ShaderOutput(vec4(sample_variance(given.a.xy, given.a.zw, given.b.xy), 0.0, 0.0),
                                 vec4(0.0));
    case 13: return ShaderOutput(vec4(shortened_history(given.a.xy, given.b.xy, given.c.xy), 0.0, 0.0),
                                 vec4(0.0));
    case 14: return ShaderOutput(cubic_weights(given.a.x),
                                 vec4(virtual_distance(given.a.x, given.a.y),
                                      cubic_scale(cubic_weights(given.a.x), cubic_weights(given.a.y)),
                                      0.0, 0.0));
    case 15: return ShaderOutput(vec4(virtual_motion_threshold(given.a.x),
                                      max_virtual_history(given.a.x),
                                      surface_history_weight(given.a.y, given.a.z),
                                      frames_under_motion(given.a.w)),
                                 vec4(outdated_fraction(given.b.xx, given.b.yy, given.b.zz, given.b.w,
                                                        vec2(0.0)).x));
    case 16: return ShaderOutput(vec4(same_reflector(given.a.x, given.a.y, given.a.z, given.a.w)),
                                 vec4(0.0));
    case 17: return ShaderOutput(vec4(edge_weight(given.a.xy), 0.0, 0.0), vec4(0.0));
    default: return ShaderOutput(vec4(specular_dominant_factor(given.a.x), 0.0,
                                      sanitize(given.b.x), 0.0), vec4(sanitize(given.b.xyz), 0.0));
  }
}
