// The rays that a camera sees along: the inverse of the rasteriser's projection.
#ifndef HELIOGRAPH_CAMERA_RAY_GLSL
#define HELIOGRAPH_CAMERA_RAY_GLSL
#include "lib/frame.glsl"
#include "shared/ray.h"

/// Through the jittered sample of a pixel, from the near plane (an orthographic camera's far plane
/// ends it).
Ray camera_ray(ivec2 pixel) {
  Ray ray;
  // The third row of a projection without its view: depth = scale x view Z + offset.
  float offset = frame.unjittered[3].z;
  float near = offset;
  float far = 1e30;
  vec3 view_origin = vec3(0.0);
  vec3 view_direction = view_position(pixel, 1.0);
  if (enabled(frame_orthographic)) {
    vec3 row = vec3(frame.unjittered[0].z, frame.unjittered[1].z, frame.unjittered[2].z);
    float scale = length(row);
    float at_eye = dot(row, frame.eye.xyz) + offset;
    near = (at_eye - 1.0) / scale;
    far = at_eye / scale;
    view_origin = vec3(view_direction.xy, 0.0);
    view_direction = vec3(0.0, 0.0, -1.0);
  }
  float stretch = length(view_direction);
  ray.origin = (frame.inverse_view * vec4(view_origin, 1.0)).xyz;
  ray.direction = mat3(frame.inverse_view) * (view_direction / stretch);
  ray.t_min = max(near, 0.0) * stretch;
  ray.t_max = far;
  ray.pixel = uint(pixel.x) | uint(pixel.y) << 16u;
  ray.user = 0u;
  ray.padding0 = 0u;
  ray.padding1 = 0u;
  return ray;
}

#endif
