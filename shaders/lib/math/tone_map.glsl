// Scene-linear Rec. 709 -> display-linear [0, 1].
#ifndef HELIOGRAPH_TONE_MAP_GLSL
#define HELIOGRAPH_TONE_MAP_GLSL

/// Khronos PBR Neutral (specification of 2024): hue is kept, only highlights are compressed.
vec3 tone_map_neutral(vec3 color) {
  const float start = 0.8 - 0.04;
  const float desaturation = 0.15;
  float darkest = min(color.r, min(color.g, color.b));
  float offset = darkest < 0.08 ? darkest - 6.25 * darkest * darkest : 0.04;
  color -= offset;
  float peak = max(color.r, max(color.g, color.b));
  if (peak < start) return color;
  float d = 1.0 - start;
  float new_peak = 1.0 - d * d / (peak + d - start);
  color *= new_peak / peak;
  float g = 1.0 - 1.0 / (desaturation * (peak - new_peak) + 1.0);
  return mix(color, vec3(new_peak), g);
}

/// ACES reference rendering and sRGB output transforms, fitted by Stephen Hill.
vec3 tone_map_aces(vec3 color) {
  const mat3 input_matrix = mat3(0.59719, 0.07600, 0.02840, 0.35458, 0.90834, 0.13383, 0.04823,
                                 0.01566, 0.83777);
  const mat3 output_matrix = mat3(1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276,
                                  -0.07367, -0.00605, 1.07602);
  vec3 v = input_matrix * (color / 0.6);
  vec3 fitted = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
  return clamp(output_matrix * fitted, 0.0, 1.0);
}

/// AgX (Troy Sobotka), the base look with the sixth-order contrast fit of Benjamin Wrensch.
vec3 tone_map_agx(vec3 color) {
  const mat3 inset = mat3(0.842479062253094, 0.0423282422610123, 0.0423756549057051,
                          0.0784335999999992, 0.878468636469772, 0.0784336,
                          0.0792237451477643, 0.0791661274605434, 0.879142973793104);
  const mat3 outset = mat3(1.19687900512017, -0.0528968517574562, -0.0529716355144438,
                           -0.0980208811401368, 1.15190312990417, -0.0980434501171241,
                           -0.0990297440797205, -0.0989611768448433, 1.15107367264116);
  const float darkest = -12.47393;
  const float brightest = 4.026069;
  vec3 v = log2(max(inset * color, vec3(1e-10)));
  v = (clamp(v, darkest, brightest) - darkest) / (brightest - darkest);
  vec3 v2 = v * v;
  vec3 v4 = v2 * v2;
  v = 15.5 * v4 * v2 - 40.14 * v4 * v + 31.96 * v4 - 6.868 * v2 * v + 0.4298 * v2 + 0.1191 * v -
      0.00232;
  return pow(max(outset * v, vec3(0.0)), vec3(2.2));
}

/// IEC 61966-2-1.
vec3 srgb_encode(vec3 linear) {
  vec3 c = clamp(linear, 0.0, 1.0);
  return mix(1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, 12.92 * c, lessThanEqual(c, vec3(0.0031308)));
}

#endif
