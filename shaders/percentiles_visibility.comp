#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/visibility_signal.glsl"
#include "lib/percentiles.glsl"
