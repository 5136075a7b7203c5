// What a material's extensions make of a point of it, and how the G-buffer keeps that.
#ifndef HELIOGRAPH_LAYERS_GLSL
#define HELIOGRAPH_LAYERS_GLSL
#include "lib/lighting/brdf.glsl"
#include "lib/math/octahedral.glsl"
#include "lib/scene/thin_film.glsl"

/// The texels of a layer's textures at a point; 1 where it has none.
struct LayerTexels {
  float specular;
  vec3 specular_color;
  float coat;
  float coat_roughness;
  vec3 sheen;
  float sheen_roughness;
  float transmission;
  float thickness;  // times the instance's scale
  float iridescence;
  float film;
  float anisotropy;
  float diffuse_transmission;
  vec3 diffuse_tint;
};

ThinFilm thin_film(MaterialLayer from, LayerTexels texels) {
  ThinFilm film;
  film.thickness = mix(from.film_least, from.film_thickness, texels.film);
  film.share = film.thickness > 0.0 ? from.iridescence * texels.iridescence : 0.0;
  film.ior = from.film_ior;
  return film;
}

/// The grain in the plane of tangent and bitangent, from the texel of its texture.
vec2 grain_in_plane(MaterialLayer from, vec2 texel) {
  // Without a texture along the tangent: a whole number divides to 1 only by itself.
  vec2 grain = mix(texel * 2.0 - 1.0, vec2(1.0, 0.0),
                   float(from.anisotropy_texture.texture / no_texture));
  return vec2(from.grain_x * grain.x - from.grain_y * grain.y,
              from.grain_y * grain.x + from.grain_x * grain.y);
}

/// Without the film and without diffuse transmission. `grain`: world space, of any length; 0 where
/// there is none.
SurfaceLayer surface_layer(MaterialLayer from, LayerTexels texels, vec3 coat_normal, vec3 grain) {
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
  float size = dot(grain, grain);
  layer.grain = grain * inversesqrt(max(size, 1e-12));
  layer.anisotropy = size > 1e-6 ? from.anisotropy * texels.anisotropy : 0.0;
  layer.diffuse_transmission = 0.0;
  layer.diffuse_tint = vec3(0.0);
  return layer;
}

/// Of scenes that have any. The wall is thin: what it lets through is what the whole thickness of
/// the volume leaves.
void add_diffuse_transmission(MaterialLayer from, LayerTexels texels, inout SurfaceLayer layer) {
  layer.diffuse_transmission = from.diffuse_transmission * texels.diffuse_transmission;
  layer.diffuse_tint =
      from.diffuse_tint * texels.diffuse_tint * exp(-from.absorption * texels.thickness);
}

const uint packed_grain = 1u << 30u;
const uint packed_tint = 1u << 31u;

/// The direction of a line in the plane of `normal`: 0 to 1, round the circle once for half a turn.
float encode_grain(vec3 grain, vec3 normal) {
  vec3 tangent, bitangent;
  storage_basis(normal, tangent, bitangent);
  vec2 p = vec2(dot(grain, tangent), dot(grain, bitangent));
  float share = p.y / max(abs(p.x) + abs(p.y), 1e-12);
  return (p.x >= 0.0 ? share : -share) * 0.5 + 0.5;
}

vec3 decode_grain(float share, vec3 normal) {
  vec3 tangent, bitangent;
  storage_basis(normal, tangent, bitangent);
  float y = share * 2.0 - 1.0;
  return normalize(tangent * (1.0 - abs(y)) + bitangent * y);
}

/// Of a pixel that lets no light through. The base layer's roughness goes with it: the G-buffer's
/// own is that of the smoother lobe. A grain about the shading `normal` takes bits of the coat's
/// normal, which keeps 12 a coordinate, and of the sheen, which keeps 6 a component. The tint of
/// diffuse transmission takes the place of the coat's normal, which becomes the shading normal.
uvec4 pack_layer(SurfaceLayer layer, float roughness, vec3 normal) {
  uvec3 f0 = uvec3(sqrt(clamp(layer.f0, 0.0, 1.0)) * 1023.0 + 0.5);
  vec2 coat_normal = octahedral_encode(layer.coat_normal);
  vec4 sheen = vec4(sqrt(layer.sheen), layer.sheen_roughness);
  uvec4 bits = uvec4(f0.r | f0.g << 10u | f0.b << 20u, packSnorm2x16(coat_normal),
                     packUnorm4x8(vec4(layer.coat, layer.coat_roughness, roughness, layer.f90)),
                     packUnorm4x8(sheen));
  if (layer.anisotropy > 0.0) {
    // An even number of steps: normals along an axis stay what they are.
    uvec2 n = uvec2((coat_normal * 0.5 + 0.5) * 4094.0 + 0.5);
    uvec4 s = uvec4(clamp(sheen, 0.0, 1.0) * 63.0 + 0.5);
    uvec2 grain = uvec2(vec2(layer.anisotropy, encode_grain(layer.grain, normal)) * 255.0 + 0.5);
    bits.x |= packed_grain;
    bits.y = n.x | n.y << 12u | grain.x << 24u;
    bits.w = s.r | s.g << 6u | s.b << 12u | s.a << 18u | grain.y << 24u;
  }
  if (layer.diffuse_transmission > 0.0) {
    uvec3 tint = uvec3(sqrt(clamp(layer.diffuse_tint, 0.0, 1.0)) * 255.0 + 0.5);
    uint strength = layer.anisotropy > 0.0 ? bits.y & 0xff000000u : 0u;
    bits.x |= packed_tint;
    bits.y = strength | tint.r | tint.g << 8u | tint.b << 16u;
  }
  return bits;
}

SurfaceLayer unpack_layer(uvec4 bits, vec3 normal, out float roughness) {
  vec3 f0 = vec3(uvec3(bits.x, bits.x >> 10u, bits.x >> 20u) & 1023u) / 1023.0;
  vec2 coat_normal = unpackSnorm2x16(bits.y);
  vec4 coat = unpackUnorm4x8(bits.z);
  vec4 sheen = unpackUnorm4x8(bits.w);
  vec3 grain = vec3(1.0, 0.0, 0.0);
  float anisotropy = 0.0;
  if ((bits.x & packed_grain) != 0u) {
    coat_normal = vec2(uvec2(bits.y, bits.y >> 12u) & 4095u) * (2.0 / 4094.0) - 1.0;
    sheen = vec4(uvec4(bits.w, bits.w >> 6u, bits.w >> 12u, bits.w >> 18u) & 63u) / 63.0;
    anisotropy = float(bits.y >> 24u) / 255.0;
    grain = decode_grain(float(bits.w >> 24u) / 255.0, normal);
  }
  roughness = coat.z;
  return SurfaceLayer(f0 * f0, coat.w, octahedral_decode(coat_normal), coat.x, coat.y,
                      sheen.rgb * sheen.rgb, sheen.a, 0.0, vec3(0.0), grain, anisotropy, 0.0,
                      vec3(0.0));
}

/// Of scenes that have any diffuse transmission. `fraction`: what the surface image has of it.
void unpack_tint(uvec4 bits, vec3 normal, float fraction, inout SurfaceLayer layer) {
  if ((bits.x & packed_tint) == 0u) return;
  vec3 root = unpackUnorm4x8(bits.y).rgb;
  layer.diffuse_transmission = fraction;
  layer.diffuse_tint = root * root;
  layer.coat_normal = normal;
}

/// Of the narrower specular lobe.
float smoother_roughness(SurfaceLayer layer, float roughness) {
  return layer.coat > 0.0 ? min(roughness, layer.coat_roughness) : roughness;
}

#endif
