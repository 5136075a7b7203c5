// The image that guides the filters of all signals: xyz the normal times 1 + roughness, w the view
// Z, 0 for the background.
#ifndef HELIOGRAPH_DENOISE_GUIDE_GLSL
#define HELIOGRAPH_DENOISE_GUIDE_GLSL

struct Guide {
  vec3 normal;  // shading normal, unit length, world space
  float roughness;
  float view_z;  // metres along -Z
};

vec4 encode_guide(Guide guide) {
  return vec4(guide.normal * (1.0 + guide.roughness), guide.view_z);
}

bool guide_is_background(vec4 texel) { return texel.w <= 0.0; }

/// Also of the background, where the normal is zero.
Guide decode_guide(vec4 texel) {
  float size = max(length(texel.xyz), 1e-6);
  return Guide(texel.xyz / size, size - 1.0, texel.w);
}

#endif
