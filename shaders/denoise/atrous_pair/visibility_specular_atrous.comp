#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/denoise/atrous_half_pair.glsl"
