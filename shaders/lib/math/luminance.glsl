// Luminance of linear colours with the primaries of sRGB.
#ifndef HELIOGRAPH_LUMINANCE_GLSL
#define HELIOGRAPH_LUMINANCE_GLSL

float luminance(vec3 color) { return dot(color, vec3(0.2126, 0.7152, 0.0722)); }

#endif
