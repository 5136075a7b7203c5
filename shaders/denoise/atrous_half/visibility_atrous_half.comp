#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/denoise/visibility_signal.glsl"
#include "lib/denoise/atrous_half.glsl"
