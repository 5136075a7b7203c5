#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
#define GBUFFER_LAYERED
#define GBUFFER_FIRST
#define GBUFFER_DRAWN
#include "lib/scene/gbuffer_round.glsl"
