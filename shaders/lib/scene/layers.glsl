// What a material's extensions make of a point of it, and how the G-buffer keeps that.
#ifndef HELIOGRAPH_LAYERS_GLSL
#define HELIOGRAPH_LAYERS_GLSL
#include "lib/lighting/brdf.glsl"
#include "lib/math/octahedral.glsl"

/// The texels of a layer's textures at a point; 1 where it has none.
struct LayerTexels {
  float specular;
  vec3 specular_color;
  float coat;
  float coat_roughness;
  vec3 sheen;
  float sheen_roughness;
  float transmission;
  float thickness;
};

SurfaceLayer surface_layer(MaterialLayer from, LayerTexels texels, vec3 coat_normal) {
  SurfaceLayer layer;
  layer.f90 = from.specular * texels.specular;
  layer.f0 = layer.f90 * min(from.dielectric * from.specular_color * texels.specular_color,
                                     vec3(1.0));
  layer.coat_normal = coat_normal;
  layer.coat = from.coat * texels.coat;
  layer.coat_roughness = from.coat_roughness * texels.coat_roughness;
  layer.sheen = from.sheen * texels.sheen;
  layer.sheen_roughness = from.sheen_roughness * texels.sheen_roughness;
  layer.transmission = from.transmission * texels.transmission;
  layer.transmitted = layer.transmission * exp(-from.absorption * texels.thickness);
  return layer;
}

/// Of a pixel that lets no light through. The base layer's roughness goes with it: the G-buffer's
/// own is that of the smoother lobe.
uvec4 pack_layer(SurfaceLayer layer, float roughness) {
  uvec3 f0 = uvec3(sqrt(clamp(layer.f0, 0.0, 1.0)) * 1023.0 + 0.5);
  return uvec4(f0.r | f0.g << 10u | f0.b << 20u,
               packSnorm2x16(octahedral_encode(layer.coat_normal)),
               packUnorm4x8(vec4(layer.coat, layer.coat_roughness, roughness, layer.f90)),
               packUnorm4x8(vec4(sqrt(layer.sheen), layer.sheen_roughness)));
}

SurfaceLayer unpack_layer(uvec4 bits, out float roughness) {
  vec3 f0 = vec3(uvec3(bits.x, bits.x >> 10u, bits.x >> 20u) & 1023u) / 1023.0;
  vec4 coat = unpackUnorm4x8(bits.z);
  vec4 sheen = unpackUnorm4x8(bits.w);
  roughness = coat.z;
  return SurfaceLayer(f0 * f0, coat.w, octahedral_decode(unpackSnorm2x16(bits.y)), coat.x,
                      coat.y, sheen.rgb * sheen.rgb, sheen.a, 0.0, vec3(0.0));
}

/// Of the narrower specular lobe.
float smoother_roughness(SurfaceLayer layer, float roughness) {
  return layer.coat > 0.0 ? min(roughness, layer.coat_roughness) : roughness;
}

#endif
