// Rays and hits as passes write them: in rows of 16 bytes. Written member by member, each store of
// a group would touch as many sectors of memory as it has threads. The bytes are those of ray.h.
#ifndef HELIOGRAPH_STORED_RAYS_GLSL
#define HELIOGRAPH_STORED_RAYS_GLSL
#include "shared/ray.h"

struct StoredRay {
  vec4 origin;     // w: t_min
  vec4 direction;  // w: t_max
  uvec4 rest;      // pixel, user and what passes keep beside them
};

StoredRay stored(Ray ray) {
  return StoredRay(vec4(ray.origin, ray.t_min), vec4(ray.direction, ray.t_max),
                   uvec4(ray.pixel, ray.user, ray.padding0, ray.padding1));
}

struct StoredHit {
  uvec4 first;   // t, instance, triangle, u
  uvec4 second;  // v and what passes keep beside it
};

StoredHit stored(Hit hit) {
  return StoredHit(
      uvec4(floatBitsToUint(hit.t), hit.instance, hit.triangle, floatBitsToUint(hit.u)),
      uvec4(floatBitsToUint(hit.v), hit.padding0, hit.padding1, hit.padding2));
}

#endif
