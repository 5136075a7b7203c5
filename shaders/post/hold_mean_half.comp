#version 460
#extension GL_GOOGLE_include_directive : require
#define RESOLVED_IN_HALVES
#include "lib/post/hold_mean.glsl"
