// The material of a G-buffer's pixel, from the images `normals`, `base_color` and `surface`, which
// the pass declares before it includes this.
#ifndef HELIOGRAPH_GBUFFER_MATERIAL_GLSL
#define HELIOGRAPH_GBUFFER_MATERIAL_GLSL
#include "lib/environment.glsl"
#include "lib/octahedral.glsl"

SurfaceMaterial material_at(ivec2 pixel) {
  vec4 encoded = imageLoad(normals, pixel);
  vec4 color = imageLoad(base_color, pixel);
  vec4 packed_surface = imageLoad(surface, pixel);
  return surface_material(color.rgb * color.rgb, packed_surface.y, packed_surface.x,
                          octahedral_decode(encoded.xy), octahedral_decode(encoded.zw),
                          to_eye(pixel));
}

bool is_unlit(ivec2 pixel) { return imageLoad(surface, pixel).z > 0.5; }

#endif
