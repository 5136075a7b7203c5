#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define READS_RADIANCE_CACHE
#include "lib/rays/specular_shade.glsl"
