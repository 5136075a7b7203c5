// Low-discrepancy numbers per pixel: the Sobol sequence twice, once over the pixels in the order of
// a quadtree and once over the samples, each with Owen's scrambling, joined by exclusive or. Every
// square of pixels holds a net in every sample, so errors lie in high frequencies (Ahmed and Wonka
// 2020), and every pixel's samples are a net, so each converges like 1/N or better.
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

/// Changes every bit by a hash of the bits below it: Owen's scrambling of a number whose first
/// digit is the lowest bit (Laine and Karras 2011, Burley 2020; constants by Vegdahl).
uint scramble_upward(uint v, uint seed) {
  v ^= v * 0x3d20adeau;
  v += seed;
  v *= (seed >> 16u) | 1u;
  v ^= v * 0x05526c56u;
  v ^= v * 0x53a22864u;
  return v;
}

/// The same with the highest bit first: a shuffle that keeps every aligned run of 2^n together.
uint shuffle(uint v, uint seed) {
  return bitfieldReverse(scramble_upward(bitfieldReverse(v), seed));
}

/// Digits of Sobol's second dimension, the first in the lowest bit: the digits of the index times
/// Pascal's triangle modulo 2, whose entry (j, k) is odd where the bits of j are among those of k.
uint sobol_second(uint v) {
  v ^= (v >> 1u) & 0x55555555u;
  v ^= (v >> 2u) & 0x33333333u;
  v ^= (v >> 4u) & 0x0f0f0f0fu;
  v ^= (v >> 8u) & 0x00ff00ffu;
  return v ^ (v >> 16u);
}

/// A bit of x, then one of y, from the lowest up; 16 bits of each.
uint quadtree_order(uvec2 pixel) {
  uvec2 v = pixel & 0xffffu;
  v = (v | (v << 8u)) & 0x00ff00ffu;
  v = (v | (v << 4u)) & 0x0f0f0f0fu;
  v = (v | (v << 2u)) & 0x33333333u;
  v = (v | (v << 1u)) & 0x55555555u;
  return v.x | (v.y << 1u);
}

/// The indices of a pixel and a sample in the two sequences of a dimension.
uvec2 sequence_indices(uvec2 pixel, uint sample_index, uvec3 keys) {
  return uvec2(shuffle(quadtree_order(pixel), keys.x), shuffle(sample_index, keys.y));
}

float unit_interval(uint digits) { return float(bitfieldReverse(digits) >> 8u) * exp2(-24.0); }

/// Two numbers in [0, 1) for a pixel, a sample of its sequence and an independent dimension.
vec2 random_pair(uvec2 pixel, uint sample_index, uint dimension, uint seed) {
  uvec3 keys = pcg3d(uvec3(dimension, seed, 0u));
  uvec3 more = pcg3d(uvec3(dimension, seed, 1u));
  uvec2 indices = sequence_indices(pixel, sample_index, keys);
  uint first = scramble_upward(indices.x, keys.z) ^ scramble_upward(indices.y, more.x);
  uint second = scramble_upward(sobol_second(indices.x), more.y) ^
                scramble_upward(sobol_second(indices.y), more.z);
  return vec2(unit_interval(first), unit_interval(second));
}

/// One number, independent of the pairs of every dimension.
float random_number(uvec2 pixel, uint sample_index, uint dimension, uint seed) {
  uvec3 keys = pcg3d(uvec3(dimension, seed, 2u));
  uvec2 indices = sequence_indices(pixel, sample_index, keys);
  return unit_interval(scramble_upward(indices.x, keys.z) ^
                       scramble_upward(indices.y, keys.x ^ keys.y));
}

#endif
