#version 460
#extension GL_GOOGLE_include_directive : require
#define FILTERED_IN_FLOATS
#include "lib/denoise/specular_signal.glsl"
#include "lib/denoise/atrous_half.glsl"
