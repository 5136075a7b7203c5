// Rays and hits as they travel between generation, tracing and shading: std430.
#ifndef HELIOGRAPH_SHARED_RAY_H
#define HELIOGRAPH_SHARED_RAY_H
#include "types.h"
SHARED_BEGIN

// World space. `pixel` is x | y << 16 of the pixel that asked; tracers leave it alone.
struct Ray {
  vec3 origin;
  float t_min;
  vec3 direction;  // unit length
  float t_max;
  uint pixel;
  uint user;  // whatever the generating pass wants back when shading
  uint padding0;
  uint padding1;
};

SHARED_CONSTANT uint hit_none = 0xffffffffu;

// Closest hits. Barycentric (u, v) weigh the second and third vertex. instance == hit_none: a miss.
struct Hit {
  float t;
  uint instance;
  uint triangle;  // within the instance's mesh
  float u;
  float v;
  uint padding0;
  uint padding1;
  uint padding2;
};

// In front of a ray stream: how many rays there are, the indirect dispatch that covers them, and
// how they meet blended surfaces.
struct RayCount {
  uint count;
  uint groups_x;  // VkDispatchIndirectCommand
  uint groups_y;
  uint groups_z;
  uint blending;  // 0: blended surfaces stop every ray; else a number of this frame, with which
                  // they stop a random fraction of them, equal to their coverage
  uint tracing_groups_x;  // VkDispatchIndirectCommand of passes that walk the hierarchy
  uint tracing_groups_y;
  uint tracing_groups_z;
};

// No device starts more than 65,535 groups in a row: longer streams take several rows.
SHARED_CONSTANT uint rays_per_group = 64u;
SHARED_CONSTANT uint groups_per_row = 32768u;
SHARED_CONSTANT uint rays_per_row = 2097152u;

// Few rays are spread over more groups of at least so many, up to a number of groups that fills a
// large device once: a group takes as long as all the ways that its rays go, and the pass as long
// as its slowest group.
SHARED_CONSTANT uint least_rays_per_group = 8u;
SHARED_CONSTANT uint spread_groups = 1024u;

// How many groups walk the hierarchy for so many rays. Grows with them.
SHARED_FUNCTION uint tracing_groups(uint rays) {
  uint full = (rays + rays_per_group - 1u) / rays_per_group;
  uint sparse = (rays + least_rays_per_group - 1u) / least_rays_per_group;
  uint spread = sparse < spread_groups ? sparse : spread_groups;
  return full > spread ? full : spread;
}

SHARED_END
#endif
