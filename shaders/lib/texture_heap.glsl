// Reads the texture heap as a sampler would read the image (Vulkan 1.3, 16.6 to 16.9).
#ifndef HELIOGRAPH_TEXTURE_HEAP_GLSL
#define HELIOGRAPH_TEXTURE_HEAP_GLSL
#include "lib/scene_tables.glsl"

/// A texel's index along one axis of `size` texels, brought back into the image.
int wrapped_texel(int texel, int size, uint mode) {
  if (mode == wrap_clamp) return clamp(texel, 0, size - 1);
  int period = mode == wrap_mirror ? 2 * size : size;
  texel -= int(floor(float(texel) / float(period))) * period;
  texel = clamp(texel, 0, period - 1);
  return texel < size ? texel : period - 1 - texel;
}

/// IEC 61966-2-1.
vec3 srgb_decode(vec3 encoded) {
  return mix(pow((encoded + 0.055) / 1.055, vec3(2.4)), encoded / 12.92,
             lessThanEqual(encoded, vec3(0.04045)));
}

vec4 heap_texel(HeapTexture t, uint first, ivec2 size, ivec2 texel) {
  ivec2 inside = ivec2(wrapped_texel(texel.x, size.x, t.wrap_s),
                       wrapped_texel(texel.y, size.y, t.wrap_t));
  vec4 color = unpackUnorm4x8(texelFetch(texture_heap, int(first) + inside.y * size.x + inside.x).x);
  if ((t.flags & texture_srgb) != 0u) color.rgb = srgb_decode(color.rgb);
  return color;
}

vec4 sample_level(HeapTexture t, vec2 uv, uint level, bool nearest) {
  uint first = t.first_texel;
  for (uint i = 0u; i < level; ++i) first += max(t.width >> i, 1u) * max(t.height >> i, 1u);
  ivec2 size = max(ivec2(t.width, t.height) >> int(level), ivec2(1));
  // Whole turns first, so that large coordinates keep their fraction.
  if (t.wrap_s != wrap_clamp) uv.x -= 2.0 * floor(0.5 * uv.x);
  if (t.wrap_t != wrap_clamp) uv.y -= 2.0 * floor(0.5 * uv.y);
  vec2 at = clamp(uv, -4.0, 4.0) * vec2(size);
  if (nearest) return heap_texel(t, first, size, ivec2(floor(at)));
  vec2 corner = floor(at - 0.5);
  vec2 share = at - 0.5 - corner;
  ivec2 texel = ivec2(corner);
  vec4 top = mix(heap_texel(t, first, size, texel),
                 heap_texel(t, first, size, texel + ivec2(1, 0)), share.x);
  vec4 bottom = mix(heap_texel(t, first, size, texel + ivec2(0, 1)),
                    heap_texel(t, first, size, texel + ivec2(1, 1)), share.x);
  return mix(top, bottom, share.y);
}

/// The texture at `uv`. `lod` counts from the largest level that the heap keeps.
vec4 sample_texture(uint index, vec2 uv, float lod) {
  HeapTexture t = textures[index];
  if (lod <= 0.0 || t.levels == 1u) {
    uint filtering = lod <= 0.0 ? texture_magnify_nearest : texture_minify_nearest;
    return sample_level(t, uv, 0u, (t.flags & filtering) != 0u);
  }
  bool nearest = (t.flags & texture_minify_nearest) != 0u;
  lod = min(lod, float(t.levels - 1u));
  if ((t.flags & texture_levels_nearest) != 0u) {
    return sample_level(t, uv, uint(ceil(lod + 0.5) - 1.0), nearest);
  }
  uint level = uint(lod);
  vec4 finer = sample_level(t, uv, level, nearest);
  float share = lod - float(level);
  if (share == 0.0) return finer;
  return mix(finer, sample_level(t, uv, level + 1u, nearest), share);
}

#endif
