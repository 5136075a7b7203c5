#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/denoise/specular_signal.glsl"
#include "lib/denoise/spatial_variance.glsl"

// The history holds no variance.
void keep(ivec2 pixel, vec4 value) {}
