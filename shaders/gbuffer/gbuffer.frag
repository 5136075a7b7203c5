#version 460
#extension GL_GOOGLE_include_directive : require
#define GBUFFER_OPAQUE
#include "lib/scene/gbuffer_surface.glsl"
