// What is drawn nearest to the camera at a pixel: t of the hit in the upper half, whose bits grow
// with it, the triangle's slot in the lower.
#ifndef HELIOGRAPH_DRAWN_KEY_GLSL
#define HELIOGRAPH_DRAWN_KEY_GLSL
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require

const uint64_t drawn_nothing = ~uint64_t(0);

uint64_t drawn_key(float t, uint slot) {
  return uint64_t(floatBitsToUint(t)) << 32 | uint64_t(slot);
}

uint drawn_slot(uint64_t key) { return uint(key); }

#endif
