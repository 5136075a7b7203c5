#version 460
#extension GL_GOOGLE_include_directive : require
#define GBUFFER_OPAQUE
#define GBUFFER_LAYERED
#include "lib/scene/gbuffer_surface.glsl"
