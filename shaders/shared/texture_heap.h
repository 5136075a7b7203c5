// Where the texture heap keeps a texture: std430.
#ifndef HELIOGRAPH_SHARED_TEXTURE_HEAP_H
#define HELIOGRAPH_SHARED_TEXTURE_HEAP_H
#include "types.h"
SHARED_BEGIN

SHARED_CONSTANT uint texture_srgb = 1u;
SHARED_CONSTANT uint texture_magnify_nearest = 2u;
SHARED_CONSTANT uint texture_minify_nearest = 4u;
SHARED_CONSTANT uint texture_levels_nearest = 8u;

struct HeapTexture {
  uint first_texel;  // of the largest level kept; smaller ones follow, each row by row
  uint width;        // of that level
  uint height;
  uint levels;  // 1 where the sampler never reads smaller ones
  uint wrap_s;  // values of wrap_*
  uint wrap_t;
  uint flags;  // texture_*
  uint padding0;
};

SHARED_END
#endif
