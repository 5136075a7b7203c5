// The material of a G-buffer's pixel, from the images `normals`, `base_color`, `surface` and
// `surface_layers`, which the pass declares before it includes this.
#ifndef HELIOGRAPH_GBUFFER_MATERIAL_GLSL
#define HELIOGRAPH_GBUFFER_MATERIAL_GLSL
#include "lib/lighting/environment.glsl"
#include "lib/scene/layers.glsl"

SurfaceMaterial material_at(ivec2 pixel) {
  vec4 encoded = imageLoad(normals, pixel);
  vec4 color = imageLoad(base_color, pixel);
  vec4 packed_surface = imageLoad(surface, pixel);
  float roughness = packed_surface.x;
  vec3 normal = octahedral_decode(encoded.xy);
  SurfaceLayer layer = plain_layer();
  if (scene_has(scene_layers)) {
    uvec4 bits = imageLoad(surface_layers, pixel);
    layer = unpack_layer(bits, normal, roughness);
    if (scene_has(scene_diffuse_transmits)) unpack_tint(bits, normal, packed_surface.w, layer);
  }
  return surface_material(color.rgb * color.rgb, packed_surface.y, roughness, normal,
                          octahedral_decode(encoded.zw), to_eye(pixel), layer);
}

bool is_unlit(ivec2 pixel) { return imageLoad(surface, pixel).z > 254.5 / 255.0; }

#endif
