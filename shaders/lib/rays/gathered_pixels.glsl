// Pixels of a workgroup that need work, gathered so that neighbouring invocations have it: where
// few of them do, one subgroup works in place of all. Include after declaring a workgroup size of
// 16 x 16; every invocation calls gather_pixel() once.
#ifndef HELIOGRAPH_GATHERED_PIXELS_GLSL
#define HELIOGRAPH_GATHERED_PIXELS_GLSL

shared uint gathered_count;
shared uint gathered[256];

void gather_pixel(bool wanted, ivec2 pixel) {
  if (gl_LocalInvocationIndex == 0u) gathered_count = 0u;
  barrier();
  if (wanted) gathered[atomicAdd(gathered_count, 1u)] = uint(pixel.x) | uint(pixel.y) << 16u;
  barrier();
}

/// Whether the invocation has one of them.
bool has_gathered_pixel() { return gl_LocalInvocationIndex < gathered_count; }

ivec2 gathered_pixel() {
  uint pixel = gathered[gl_LocalInvocationIndex];
  return ivec2(pixel & 0xffffu, pixel >> 16u);
}

#endif
