#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/post/temporal_antialias.glsl"
