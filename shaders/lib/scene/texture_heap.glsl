// Reads the texture heap as a sampler would read the image (Vulkan 1.3, 16.6 to 16.9).
#ifndef HELIOGRAPH_TEXTURE_HEAP_GLSL
#define HELIOGRAPH_TEXTURE_HEAP_GLSL
#include "lib/scene/scene_tables.glsl"

/// A texel's index along one axis of `size` texels, brought back into the image from as far as a
/// coordinate is in within_period(), and one texel more on either side.
int wrapped_texel(int texel, int size, uint mode) {
  if (mode == wrap_mirror) {
    texel = texel < 0 ? -1 - texel : texel;
    if (texel >= 2 * size) texel -= 2 * size;
    texel = texel < size ? texel : 2 * size - 1 - texel;
  } else if (mode != wrap_clamp) {
    if (texel < 0) texel += size;
    texel = texel < size ? texel : texel - size;
  }
  // Of one texel, the one beyond; of a coordinate that is no number, whatever it became.
  return clamp(texel, 0, size - 1);
}

/// A coordinate without whole repetitions of the image, so that large ones keep their fraction: 0 to
/// 2 where it is mirrored, to 1 where it repeats, within 4 where it is clamped.
float within_period(float coordinate, uint mode) {
  if (mode == wrap_clamp) return clamp(coordinate, -4.0, 4.0);
  if (mode == wrap_mirror) return clamp(coordinate - 2.0 * floor(0.5 * coordinate), 0.0, 2.0);
  return clamp(coordinate - floor(coordinate), 0.0, 1.0);
}

/// IEC 61966-2-1 by a polynomial, within 0.0005: powers would cost more than the texels.
vec3 srgb_decode(vec3 e) {
  return e * (0.0457505 + e * (0.4940478 + e * (0.6158348 - 0.1561215 * e)));
}

vec4 heap_texel(HeapTexture t, uint index) {
  vec4 color = unpackUnorm4x8(texelFetch(texture_heap, int(index)).x);
  return vec4(mix(color.rgb, srgb_decode(color.rgb), float(t.flags & texture_srgb)), color.a);
}

/// One level, whose texels begin at `first`. Without branches: lavapipe runs all of them.
vec4 sample_level(HeapTexture t, uint first, ivec2 size, vec2 uv, bool nearest) {
  vec2 at = uv * vec2(size) - (nearest ? 0.0 : 0.5);
  vec2 corner = floor(at);
  vec2 fraction = nearest ? vec2(0.0) : at - corner;
  ivec2 low = ivec2(corner);
  uint left = uint(wrapped_texel(low.x, size.x, t.wrap_s));
  uint right = uint(wrapped_texel(low.x + 1, size.x, t.wrap_s));
  uint top = first + uint(wrapped_texel(low.y, size.y, t.wrap_t) * size.x);
  uint bottom = first + uint(wrapped_texel(low.y + 1, size.y, t.wrap_t) * size.x);
  return mix(mix(heap_texel(t, top + left), heap_texel(t, top + right), fraction.x),
             mix(heap_texel(t, bottom + left), heap_texel(t, bottom + right), fraction.x),
             fraction.y);
}

/// The texture at `uv`. `lod` counts from the largest level that the heap keeps. Where
/// TEXTURE_ONE_LEVEL is defined, only the nearest level is read.
vec4 sample_texture(uint index, vec2 uv, float lod) {
  HeapTexture t = textures[index];
  bool nearest = (t.flags & (lod <= 0.0 ? texture_magnify_nearest : texture_minify_nearest)) != 0u;
  uv = vec2(within_period(uv.x, t.wrap_s), within_period(uv.y, t.wrap_t));
  lod = clamp(lod, 0.0, float(t.levels - 1u));
  if ((t.flags & texture_levels_nearest) != 0u) lod = max(ceil(lod + 0.5) - 1.0, 0.0);
#ifdef TEXTURE_ONE_LEVEL
  lod = round(lod);
#endif
  uint level = uint(lod);
  uint first = t.first_texel;
  for (uint i = 0u; i < level; ++i) first += max(t.width >> i, 1u) * max(t.height >> i, 1u);
  ivec2 size = max(ivec2(t.width, t.height) >> int(level), ivec2(1));
  vec4 finer = sample_level(t, first, size, uv, nearest);
#ifdef TEXTURE_ONE_LEVEL
  return finer;
#else
  bool last = level + 1u >= t.levels;
  uint coarser_first = last ? first : first + uint(size.x * size.y);
  ivec2 coarser_size = last ? size : max(size >> 1, ivec2(1));
  return mix(finer, sample_level(t, coarser_first, coarser_size, uv, nearest), lod - float(level));
#endif
}

#endif
