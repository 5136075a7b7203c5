#version 460
#extension GL_GOOGLE_include_directive : require
// The same with holes; kept apart because a shader that can discard loses early depth tests.
#include "lib/scene/gbuffer_surface.glsl"
