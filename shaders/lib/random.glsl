// Low-discrepancy numbers per pixel: a hashed offset for each pixel and dimension, moved from
// sample to sample by the R2 sequence (Roberts 2018), so that every pixel converges like 1/N.
#ifndef HELIOGRAPH_RANDOM_GLSL
#define HELIOGRAPH_RANDOM_GLSL

/// PCG3D (Jarzynski and Olano 2020).
uvec3 pcg3d(uvec3 v) {
  v = v * 1664525u + 1013904223u;
  v.x += v.y * v.z;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v ^= v >> 16u;
  v.x += v.y * v.z;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  return v;
}

/// Two numbers in [0, 1) for a pixel, a sample of its sequence and an independent dimension.
vec2 random_pair(uvec2 pixel, uint sample_index, uint dimension, uint seed) {
  uvec3 bits = pcg3d(uvec3(pixel, seed * 64u + dimension));
  // 2^32 / plastic number and its square, so that the sequence wraps exactly.
  uvec2 walk = bits.xy + sample_index * uvec2(3242174889u, 2447445414u);
  return vec2(walk >> 8u) * (1.0 / 16777216.0);
}

float random_number(uvec2 pixel, uint sample_index, uint dimension, uint seed) {
  uvec3 bits = pcg3d(uvec3(pixel, seed * 64u + dimension));
  uint walk = bits.z + sample_index * 2654435769u;  // 2^32 / golden ratio
  return float(walk >> 8u) * (1.0 / 16777216.0);
}

#endif
