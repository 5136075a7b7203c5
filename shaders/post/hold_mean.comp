#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/post/hold_mean.glsl"
