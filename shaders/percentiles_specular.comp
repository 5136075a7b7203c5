#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/specular_signal.glsl"
#include "lib/percentiles.glsl"
