#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// Finds the largest circle of confusion of each tile's pixels in front of the focus, pixels.
#include "lib/lens/defocus.glsl"

layout(set = 1, binding = 0, rgba32f) readonly uniform image2D motion;  // w: view Z
layout(set = 1, binding = 1, std430) writeonly buffer Reach { float reach[]; };

void main() {
  uvec2 tiles = defocus_tiles(frame.extent);
  uvec2 tile = gl_GlobalInvocationID.xy;
  if (any(greaterThanEqual(tile, tiles))) return;
  uint side = defocus_tile(frame.extent);
  uvec2 first = tile * side, last = min(first + side, frame.extent);
  float largest = 0.0;
  for (uint y = first.y; y < last.y; ++y) {
    for (uint x = first.x; x < last.x; ++x) {
      float distance = distance_of(imageLoad(motion, ivec2(x, y)).w);
      if (distance < frame.focus_distance) largest = max(largest, blur_radius(distance));
    }
  }
  reach[tile.y * tiles.x + tile.x] = largest;
}
