// Diffuse light that a surface gets from both of its sides (KHR_materials_diffuse_transmission), in
// one signal: light of each side times its share of spread_albedo(), which composition multiplies
// the signal by.
#ifndef HELIOGRAPH_TWO_SIDED_LIGHT_GLSL
#define HELIOGRAPH_TWO_SIDED_LIGHT_GLSL
#include "lib/lighting/brdf.glsl"
#include "lib/math/luminance.glsl"

struct SideShares {
  vec3 near;
  vec3 behind;
  float pick_behind;  // probability of a ray to the other side, in proportion to its light
};

SideShares side_shares(SurfaceMaterial m) {
  vec3 both = spread_albedo(m);
  vec3 by = 1.0 / max(both, vec3(1e-6));
  float behind = luminance(m.diffuse_transmitted) / max(luminance(both), 1e-6);
  return SideShares(wide_albedo(m) * by, m.diffuse_transmitted * by, behind);
}

/// In a word that is not 0.
uint pack_side_share(vec3 share) {
  uvec3 tenths = uvec3(clamp(share, 0.0, 1.0) * 1023.0 + 0.5);
  return 1u << 31u | tenths.r | tenths.g << 10u | tenths.b << 20u;
}

vec3 unpack_side_share(uint bits) {
  return vec3(uvec3(bits, bits >> 10u, bits >> 20u) & 1023u) / 1023.0;
}

#endif
