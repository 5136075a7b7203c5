#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
// Joins the coded intervals of a JPEG, with restart markers between them and the end of the image
// behind the last. Each workgroup writes the words that begin within one interval: straight to the
// host's memory, as much as there is. Where an interval does not fit, all of them write the pixels
// instead: by the time the host asked for those, the next frame could be drawn in their place.
#include "shared/jpeg.h"

layout(set = 1, binding = 0, std430) readonly buffer Slots { uint slots[]; };
layout(set = 1, binding = 1, std430) readonly buffer Lengths { uint lengths[]; };
layout(set = 1, binding = 2, std430) readonly buffer Places { uint places[]; };
layout(set = 1, binding = 3, std430) writeonly buffer Joined { uint joined[]; };
layout(set = 1, binding = 4, rgba8) readonly uniform image2D shown;
layout(push_constant) uniform Constants {
  uvec2 size;  // of the image, pixels
  uint intervals;
};

const uint threads = 64u;

/// Three bytes for each pixel, row by row.
void write_pixels() {
  uint bytes = 3u * size.x * size.y;
  uint stride = threads * gl_NumWorkGroups.x;
  for (uint word = gl_GlobalInvocationID.x; 4u * word < bytes; word += stride) {
    uint bits = 0u;
    for (uint k = 0u; k < 4u; ++k) {
      uint place = min(4u * word + k, bytes - 1u);
      uint pixel = place / 3u;
      vec4 color = imageLoad(shown, ivec2(pixel % size.x, pixel / size.x));
      bits |= uint(color[place % 3u] * 255.0 + 0.5) << (8u * k);
    }
    joined[word] = bits;
  }
}

/// Byte `i` of an interval and of the marker behind it.
uint byte_of(uint interval, uint i) {
  uint bytes = lengths[interval];
  if (i < bytes) {
    return slots[interval * jpeg_slot_words + (i >> 2)] >> (8u * (i & 3u)) & 255u;
  }
  if (i == bytes) return 0xffu;
  return interval + 1u == intervals ? 0xd9u : 0xd0u + interval % 8u;
}

void main() {
  uint interval = gl_WorkGroupID.x;
  uint all = places[intervals];
  if (all == 0u) {
    write_pixels();
    return;
  }
  if (interval >= intervals) return;
  uint first = places[interval];
  uint end = places[interval + 1u];
  // No interval is shorter than a word.
  for (uint word = (first + 3u) / 4u + gl_LocalInvocationIndex; 4u * word < end; word += threads) {
    uint bits = 0u;
    for (uint k = 0u; k < 4u; ++k) {
      uint place = 4u * word + k;
      if (place >= all) break;
      uint value =
          place < end ? byte_of(interval, place - first) : byte_of(interval + 1u, place - end);
      bits |= value << (8u * k);
    }
    joined[word] = bits;
  }
}
