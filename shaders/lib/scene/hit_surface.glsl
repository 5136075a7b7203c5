// What a ray has met: the triangle interpolated and its glTF material evaluated, as the G-buffer
// has it (lib/scene/gbuffer_surface.glsl).
#ifndef HELIOGRAPH_HIT_SURFACE_GLSL
#define HELIOGRAPH_HIT_SURFACE_GLSL
#include "lib/frame.glsl"
#include "lib/scene/layers.glsl"
#include "lib/scene/texture_heap.glsl"
#include "shared/ray.h"

/// The footprint of a ray, which grows with its length t: width + spread x t, metres
/// (Akenine-Möller et al. 2021).
struct RayCone {
  float width;
  float spread;
};

/// What of textures the rays through the middles of pixels see.
RayCone camera_cone() {
  float pixel = 2.0 * abs(frame.unproject.y) * frame.texture_footprint / float(frame.extent.y);
  return enabled(frame_orthographic) ? RayCone(pixel, 0.0) : RayCone(0.0, pixel);
}

float cone_width(RayCone cone, float t) { return cone.width + cone.spread * t; }

/// The ray cone after reflection at this roughness: the wider the lobe, the less detail it shows.
RayCone reflected_cone(RayCone cone, float t, float roughness) {
  return RayCone(cone_width(cone, t), cone.spread + 0.5 * roughness * roughness);
}

struct HitSurface {
  vec3 position;   // world
  vec3 normal;     // shading, turned to the side that the ray came from
  vec3 geometric;  // of the triangle, likewise
  vec3 front;      // of the triangle's front face, by its winding
  vec3 local;      // position, mesh space
  float area;      // of the triangle, world, square metres
  vec3 base_color;
  float alpha;
  float alpha_cutoff;
  float metallic;
  float roughness;
  float occlusion;
  vec3 emissive;  // linear radiance
  uint flags;     // material_*
  float passing;  // fraction of rays that tracers let pass where it covers
  SurfaceLayer layer;
};

/// A triangle of an instance, corner by corner.
struct HitTriangle {
  mat3x4 world;  // rows: mesh -> world
  float handedness;  // -1 where the matrix changes the handedness, or 1
  float scale;       // mesh -> world, of the thickness of volumes
  Vertex a, b, c;
  vec3 weights;
  uint material;
};

HitTriangle load_triangle(Hit hit) {
  HitTriangle t;
  mat4 world = instances[hit.instance].world;
  t.world = mat3x4(transpose(world));
  t.handedness = (instances[hit.instance].flags & instance_flipped) != 0u ? -1.0 : 1.0;
  t.scale = instances[hit.instance].scale;
  Mesh mesh = meshes[instances[hit.instance].mesh];
  uint first = mesh.first_index + 3u * hit.triangle;
  t.a = vertices[mesh.first_vertex + indices[first]];
  t.b = vertices[mesh.first_vertex + indices[first + 1u]];
  t.c = vertices[mesh.first_vertex + indices[first + 2u]];
  t.weights = vec3(1.0 - hit.u - hit.v, hit.u, hit.v);
  t.material = mesh.material;
  return t;
}

/// Mesh space.
vec3 triangle_position(HitTriangle t) {
  return t.a.position * t.weights.x + t.b.position * t.weights.y + t.c.position * t.weights.z;
}

/// Cofactors of the matrix times n, as in gbuffer.vert.
vec3 transform_normal(HitTriangle t, vec3 n) {
  vec3 x = t.world[0].xyz, y = t.world[1].xyz, z = t.world[2].xyz;
  vec3 cofactors = vec3(dot(cross(y, z), n), dot(cross(z, x), n), dot(cross(x, y), n));
  return normalize(cofactors * t.handedness);
}

vec3 transform_direction(HitTriangle t, vec3 v) { return vec4(v, 0.0) * t.world; }

/// Of the front face, twice the triangle's area long; world.
vec3 triangle_across(HitTriangle t) {
  return cross(transform_direction(t, t.b.position - t.a.position),
               transform_direction(t, t.c.position - t.a.position)) * t.handedness;
}

/// The front face's normal, of a triangle without area that of its vertices.
vec3 front_normal(vec3 across, float twice_area, vec3 vertex_normal) {
  return twice_area > 0.0 ? across / twice_area : vertex_normal;
}

vec3 interpolated_normal(HitTriangle t) {
  return normalize(transform_normal(t, t.a.normal) * t.weights.x +
                   transform_normal(t, t.b.normal) * t.weights.y +
                   transform_normal(t, t.c.normal) * t.weights.z);
}

/// Where a texture is read: both uv sets, their areas (twice that of the triangle's image), and
/// half the logarithm of the footprint's fraction of the triangle.
struct TextureLookup {
  vec4 uv;
  vec2 area;
  float footprint;
};

float twice_area(vec2 a, vec2 b, vec2 c) {
  vec2 p = b - a, q = c - a;
  return abs(p.x * q.y - p.y * q.x);
}

TextureLookup texture_lookup(HitTriangle t, float twice_world_area, float width, float cosine) {
  TextureLookup lookup;
  lookup.uv = vec4(t.a.uv0, t.a.uv1) * t.weights.x + vec4(t.b.uv0, t.b.uv1) * t.weights.y +
             vec4(t.c.uv0, t.c.uv1) * t.weights.z;
  lookup.area = vec2(twice_area(t.a.uv0, t.b.uv0, t.c.uv0), twice_area(t.a.uv1, t.b.uv1, t.c.uv1));
  lookup.footprint = log2(max(width, 1e-20) / max(cosine, 1e-2)) -
                    0.5 * log2(max(twice_world_area, 1e-30));
  return lookup;
}

/// The slot's texel; white where it has no texture.
vec4 slot_texel(TextureSlot slot, TextureLookup lookup) {
  if (slot.texture == no_texture) return vec4(1.0);
  vec2 x = slot.transform_row0.xy, y = slot.transform_row1.xy;
  vec3 uv = vec3(slot.uv_set == 0u ? lookup.uv.xy : lookup.uv.zw, 1.0);
  float area = (slot.uv_set == 0u ? lookup.area.x : lookup.area.y) * abs(x.x * y.y - x.y * y.x) *
               float(textures[slot.texture].width) * float(textures[slot.texture].height);
  float lod = 0.5 * log2(max(area, 1e-30)) + lookup.footprint;
  return sample_texture(slot.texture, vec2(dot(slot.transform_row0.xyz, uv),
                                           dot(slot.transform_row1.xyz, uv)), lod);
}

/// Unit vectors of the front face's tangent plane; false: the vertices have no tangent.
bool tangent_plane(HitTriangle t, vec3 normal, out vec3 tangent, out vec3 bitangent) {
  tangent = transform_direction(t, t.a.tangent.xyz) * t.weights.x +
            transform_direction(t, t.b.tangent.xyz) * t.weights.y +
            transform_direction(t, t.c.tangent.xyz) * t.weights.z;
  tangent -= normal * dot(normal, tangent);
  float size = dot(tangent, tangent);
  tangent *= inversesqrt(max(size, 1e-12));
  bitangent = cross(normal, tangent) * (t.a.tangent.w * t.handedness);
  return size >= 1e-12;
}

/// A normal map about the front face's `normal`.
vec3 mapped_normal(HitTriangle t, TextureSlot map, float scale, TextureLookup lookup, vec3 normal) {
  if (map.texture == no_texture) return normal;
  vec3 texel = slot_texel(map, lookup).xyz * 2.0 - 1.0;
  texel.xy *= scale;
  vec3 tangent, bitangent;
  if (!tangent_plane(t, normal, tangent, bitangent)) return normal;
  return normalize(tangent * texel.x + bitangent * texel.y + normal * texel.z);
}

vec4 vertex_color(Vertex v) {
  return vec4(unpackUnorm2x16(v.color_rg), unpackUnorm2x16(v.color_ba));
}

/// The direction in which the surface is rougher; 0: none.
vec3 grain_of(HitTriangle t, MaterialLayer from, vec2 texel, vec3 normal) {
  vec3 tangent, bitangent;
  if (!tangent_plane(t, normal, tangent, bitangent)) return vec3(0.0);
  vec2 grain = grain_in_plane(from, texel);
  return tangent * grain.x + bitangent * grain.y;
}

/// What extensions add at the front face's `normal`, without the film.
SurfaceLayer evaluate_layer(HitTriangle t, TextureLookup lookup, vec3 normal, out ThinFilm film) {
  uint number = materials[t.material].layer;
  film = ThinFilm(0.0, 1.0, 0.0);
  if (number == 0u) return plain_layer();
  MaterialLayer from = layers[number];
  LayerTexels texels;
  texels.specular = slot_texel(from.specular_texture, lookup).a;
  texels.specular_color = slot_texel(from.specular_color_texture, lookup).rgb;
  texels.coat = slot_texel(from.coat_texture, lookup).r;
  texels.coat_roughness = slot_texel(from.coat_roughness_texture, lookup).g;
  texels.sheen = slot_texel(from.sheen_color_texture, lookup).rgb;
  texels.sheen_roughness = slot_texel(from.sheen_roughness_texture, lookup).a;
  texels.transmission = slot_texel(from.transmission_texture, lookup).r;
  texels.thickness = slot_texel(from.thickness_texture, lookup).g * t.scale;
  texels.iridescence = slot_texel(from.iridescence_texture, lookup).r;
  texels.film = slot_texel(from.film_texture, lookup).g;
  vec3 grain_texel = vec3(1.0);
  vec3 grain = vec3(0.0);
  if (from.anisotropy > 0.0) {
    grain_texel = slot_texel(from.anisotropy_texture, lookup).rgb;
    grain = grain_of(t, from, grain_texel.rg, normal);
  }
  texels.anisotropy = grain_texel.b;
  film = thin_film(from, texels);
  SurfaceLayer layer = surface_layer(from, texels,
                                     mapped_normal(t, from.coat_normal_texture,
                                                   from.coat_normal_scale, lookup, normal), grain);
  if (scene_has(scene_diffuse_transmits) && from.diffuse_transmission > 0.0) {
    texels.diffuse_transmission = slot_texel(from.diffuse_transmission_texture, lookup).a;
    texels.diffuse_tint = slot_texel(from.diffuse_tint_texture, lookup).rgb;
    add_diffuse_transmission(from, texels, layer);
  }
  return layer;
}

/// The base colour with alpha, as it is without material_whole_alpha.
vec4 triangle_color(HitTriangle t, TextureLookup lookup) {
  vec4 tint = vertex_color(t.a) * t.weights.x + vertex_color(t.b) * t.weights.y +
              vertex_color(t.c) * t.weights.z;
  return materials[t.material].base_color * tint *
         slot_texel(materials[t.material].base_color_texture, lookup);
}

void evaluate_material(inout HitSurface s, HitTriangle t, TextureLookup lookup) {
  uint m = t.material;
  vec4 color = triangle_color(t, lookup);
  s.base_color = clamp(color.rgb, 0.0, 1.0);
  s.alpha = color.a;
  s.alpha_cutoff = materials[m].alpha_cutoff;
  vec4 packed_surface = slot_texel(materials[m].metallic_roughness_texture, lookup);
  s.metallic = clamp(materials[m].metallic * packed_surface.b, 0.0, 1.0);
  s.roughness = clamp(materials[m].roughness * packed_surface.g, 0.0, 1.0);
  s.occlusion = mix(1.0, slot_texel(materials[m].occlusion_texture, lookup).r,
                    materials[m].occlusion_strength);
  s.emissive = materials[m].emissive;
  if (s.emissive != vec3(0.0)) s.emissive *= slot_texel(materials[m].emissive_texture, lookup).rgb;
  s.flags = materials[m].flags;
  if ((s.flags & material_whole_alpha) != 0u) s.alpha = 1.0;
  s.passing = scene_has(scene_layers) ? materials[m].passing : 0.0;
}

/// `hit` of a ray along `direction` whose footprint at the hit is `width` metres.
HitSurface hit_surface(Hit hit, vec3 direction, float width) {
  HitTriangle t = load_triangle(hit);
  HitSurface s;
  s.local = triangle_position(t);
  s.position = vec4(s.local, 1.0) * t.world;
  vec3 vertex_normal = interpolated_normal(t);
  vec3 across = triangle_across(t);
  float twice_world_area = length(across);
  vec3 front = front_normal(across, twice_world_area, vertex_normal);
  s.front = front;
  s.area = 0.5 * twice_world_area;
  float cosine = dot(front, direction);
  float side = cosine <= 0.0 ? 1.0 : -1.0;
  // Like the G-buffer: where winding and normals disagree, the normals say which side this is.
  s.geometric = front * (dot(front, vertex_normal) < 0.0 ? -side : side);
  TextureLookup lookup = texture_lookup(t, twice_world_area, width, abs(cosine));
  s.normal = mapped_normal(t, materials[t.material].normal_texture,
                           materials[t.material].normal_scale, lookup, vertex_normal) * side;
  evaluate_material(s, t, lookup);
  s.layer = plain_layer();
  if (scene_has(scene_layers)) {
    ThinFilm film;
    s.layer = evaluate_layer(t, lookup, vertex_normal, film);
    s.layer.coat_normal *= side;
    add_film(film, material_n_dot_v(s.normal, -direction), s.metallic, s.layer, s.base_color);
  }
  return s;
}

#endif
