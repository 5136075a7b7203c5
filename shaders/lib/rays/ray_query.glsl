// Traces by VK_KHR_ray_query.
#ifndef HELIOGRAPH_LIB_RAY_QUERY_GLSL
#define HELIOGRAPH_LIB_RAY_QUERY_GLSL

#include "lib/rays/driver_hierarchy.glsl"
#include "lib/rays/ray_index.glsl"

// The closest hit, or with gl_RayFlagsTerminateOnFirstHitEXT any; hit_none where there is none.
Hit trace(Ray ray, uint flags) {
  if (!traceable(ray)) return miss(ray);
  const uint blending = ray_blending(ray, ray_count.blending);
  rayQueryEXT query;
  rayQueryInitializeEXT(query, accelerationStructureEXT(hierarchy), flags, 0xffu, ray.origin,
                        ray.t_min, ray.direction, ray.t_max);
  // Only triangles of masked meshes ask; whole ones are hit without.
  while (rayQueryProceedEXT(query)) {
    if (mask_stops(rayQueryGetIntersectionInstanceIdEXT(query, false),
                   rayQueryGetIntersectionPrimitiveIndexEXT(query, false),
                   rayQueryGetIntersectionBarycentricsEXT(query, false), blending)) {
      rayQueryConfirmIntersectionEXT(query);
    }
  }
  if (rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionNoneEXT) {
    return miss(ray);
  }
  const vec2 barycentric = rayQueryGetIntersectionBarycentricsEXT(query, true);
  return Hit(rayQueryGetIntersectionTEXT(query, true),
             rayQueryGetIntersectionInstanceIdEXT(query, true),
             rayQueryGetIntersectionPrimitiveIndexEXT(query, true), barycentric.x, barycentric.y,
             0u, 0u, 0u);
}

#endif
