#version 460
#extension GL_GOOGLE_include_directive : require
#define FILTERED_IS_RESULT
#include "lib/denoise/visibility_signal.glsl"
#include "lib/denoise/atrous_half.glsl"
