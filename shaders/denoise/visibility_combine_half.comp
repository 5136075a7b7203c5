#version 460
#extension GL_GOOGLE_include_directive : require
#define VISIBILITY_FORMAT rg16f
#include "lib/denoise/visibility_combine.glsl"
