#version 460
#extension GL_GOOGLE_include_directive : require
#define GBUFFER_LAYERED
#include "lib/gbuffer_surface.glsl"
