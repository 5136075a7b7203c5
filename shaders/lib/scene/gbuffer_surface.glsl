// Fragment stage of the G-buffer: the glTF material evaluated at a pixel, into its signals.
// GBUFFER_OPAQUE: without holes; GBUFFER_LAYERED: with what extensions add to materials.
#include "lib/frame.glsl"
#include "lib/scene/layers.glsl"

layout(location = 0) in vec3 world_normal;
layout(location = 1) in vec4 world_tangent;
layout(location = 2) in vec4 texture_uv;
layout(location = 3) in vec4 vertex_color;
layout(location = 4) in vec3 clip_now;
layout(location = 5) in vec3 clip_before;
layout(location = 6) in vec2 view_depths;
layout(location = 7) in vec3 world_point;

layout(location = 0) out vec4 normals;     // octahedral: shading xy, geometric zw
layout(location = 1) out vec4 base_color;  // square root of linear rgb, occlusion
layout(location = 2) out vec4 surface;     // roughness of the smoother lobe, metallic, unlit,
                                           // diffuse transmission
layout(location = 3) out vec4 motion;      // to the previous frame: uv, view Z; and view Z now
layout(location = 4) out vec4 emissive;    // linear radiance
layout(location = 5) out vec2 depth_slope; // view Z per pixel in x and y
layout(location = 6) out uint instance_id;
#ifdef GBUFFER_LAYERED
layout(location = 7) out uvec4 surface_layers;  // pack_layer()
#endif

layout(push_constant) uniform Constants { DrawConstants draw; };

layout(set = 2, binding = 0) uniform sampler2D base_color_map;
layout(set = 2, binding = 1) uniform sampler2D metallic_roughness_map;
layout(set = 2, binding = 2) uniform sampler2D normal_map;
layout(set = 2, binding = 3) uniform sampler2D occlusion_map;
layout(set = 2, binding = 4) uniform sampler2D emissive_map;
// Uniform, not storage: helper lanes must see it too, or the texture's level of detail is wrong.
layout(set = 2, binding = 5, std140) uniform MaterialBlock { Material material; };
#ifdef GBUFFER_LAYERED
layout(set = 2, binding = 6) uniform sampler2D specular_map;
layout(set = 2, binding = 7) uniform sampler2D specular_color_map;
layout(set = 2, binding = 8) uniform sampler2D coat_map;
layout(set = 2, binding = 9) uniform sampler2D coat_roughness_map;
layout(set = 2, binding = 10) uniform sampler2D coat_normal_map;
layout(set = 2, binding = 11) uniform sampler2D sheen_color_map;
layout(set = 2, binding = 12) uniform sampler2D sheen_roughness_map;
layout(set = 2, binding = 13) uniform sampler2D transmission_map;
layout(set = 2, binding = 14) uniform sampler2D thickness_map;
layout(set = 2, binding = 15) uniform sampler2D iridescence_map;
layout(set = 2, binding = 16) uniform sampler2D film_map;
layout(set = 2, binding = 17) uniform sampler2D anisotropy_map;
layout(set = 2, binding = 18) uniform sampler2D diffuse_transmission_map;
layout(set = 2, binding = 19) uniform sampler2D diffuse_tint_map;
layout(set = 2, binding = 20, std140) uniform LayerBlock { MaterialLayer layer; };
#endif

// No condition here hangs on constants and uniforms alone: lavapipe would make a new shader of
// every value they take, draw by draw, and keep them all.
float flag(uint flags, uint bit) { return float(min(flags & bit, 1u)); }

vec2 slot_uv(TextureSlot slot) {
  vec3 uv = vec3(mix(texture_uv.xy, texture_uv.zw, float(slot.uv_set)), 1.0);
  return vec2(dot(slot.transform_row0.xyz, uv), dot(slot.transform_row1.xyz, uv));
}

/// What the size shown needs of a texture.
vec4 detail(sampler2D map, vec2 uv) { return texture(map, uv, log2(frame.texture_footprint)); }

/// Unit vectors of the front face's tangent plane; false: the vertices have no tangent.
bool tangent_plane(vec3 normal, out vec3 tangent, out vec3 bitangent) {
  tangent = world_tangent.xyz - normal * dot(normal, world_tangent.xyz);
  float size = dot(tangent, tangent);
  tangent *= inversesqrt(max(size, 1e-12));
  bitangent = cross(normal, tangent) * world_tangent.w;
  return size >= 1e-12;
}

/// A normal map's texel about the front face's `normal`; a back face reverses the result as a
/// whole.
vec3 mapped_normal(vec3 normal, vec3 texel, float scale, uint map) {
  texel = texel * 2.0 - 1.0;
  // Without a map the normal stays: a whole number divides to 1 only by itself.
  texel.xy *= scale * (1.0 - float(map / no_texture));
  vec3 tangent, bitangent;
  if (!tangent_plane(normal, tangent, bitangent)) return normal;
  return normalize(tangent * texel.x + bitangent * texel.y + normal * texel.z);
}

/// View Z where the ray through the pixel's middle meets the plane of the triangle. Rasterisers
/// snap corners to a grid, and corners of large triangles lie far outside of the frame: what is
/// interpolated is a point of the triangle, but up to half a pixel beside the one that is looked
/// at, and a point rebuilt from its depth would lie above or below the surface.
float exact_view_z(vec3 geometric) {
  vec2 ndc = gl_FragCoord.xy / vec2(frame.extent) * 2.0 - 1.0;
  vec2 slope = ndc * frame.unproject.xy + frame.unproject.zw;
  float perspective = 1.0 - flag(frame.flags, frame_orthographic);
  vec3 through = vec3(slope * perspective, -1.0);  // for a metre of Z
  vec3 passed = vec3(slope * mix(1.0, view_depths.x, perspective), -view_depths.x);
  vec3 normal = mat3(frame.view) * geometric;
  vec3 beside = (frame.view * vec4(world_point, 1.0)).xyz - passed;
  float along = dot(normal, through);
  float depth_offset = dot(normal, beside) / (abs(along) < 1e-4 ? 1e-4 : along);
  float most = 4.0 * (abs(dFdx(view_depths.x)) + abs(dFdy(view_depths.x)));  // a few pixels away
  return view_depths.x + clamp(depth_offset, -most, most);
}

#ifdef GBUFFER_LAYERED
/// Unit vector toward the eye.
vec3 eye_here() {
  float perspective = 1.0 - flag(frame.flags, frame_orthographic);
  return normalize(mix(frame.inverse_view[2].xyz, frame.eye.xyz - world_point, perspective));
}

/// At the front face's `normal`.
SurfaceLayer layer_here(vec3 normal, out ThinFilm film) {
  LayerTexels texels;
  texels.specular = detail(specular_map, slot_uv(layer.specular_texture)).a;
  texels.specular_color = detail(specular_color_map, slot_uv(layer.specular_color_texture)).rgb;
  texels.coat = detail(coat_map, slot_uv(layer.coat_texture)).r;
  texels.coat_roughness = detail(coat_roughness_map, slot_uv(layer.coat_roughness_texture)).g;
  texels.sheen = detail(sheen_color_map, slot_uv(layer.sheen_color_texture)).rgb;
  texels.sheen_roughness = detail(sheen_roughness_map, slot_uv(layer.sheen_roughness_texture)).a;
  texels.transmission = detail(transmission_map, slot_uv(layer.transmission_texture)).r;
  texels.thickness = detail(thickness_map, slot_uv(layer.thickness_texture)).g * draw.scale;
  texels.iridescence = detail(iridescence_map, slot_uv(layer.iridescence_texture)).r;
  texels.film = detail(film_map, slot_uv(layer.film_texture)).g;
  vec3 grain_texel = detail(anisotropy_map, slot_uv(layer.anisotropy_texture)).rgb;
  texels.anisotropy = grain_texel.b;
  film = thin_film(layer, texels);
  vec2 in_plane = grain_in_plane(layer, grain_texel.rg);
  vec3 tangent, bitangent;
  bool has_tangent = tangent_plane(normal, tangent, bitangent);
  vec3 grain = has_tangent ? tangent * in_plane.x + bitangent * in_plane.y : vec3(0.0);
  texels.diffuse_transmission =
      detail(diffuse_transmission_map, slot_uv(layer.diffuse_transmission_texture)).a;
  texels.diffuse_tint = detail(diffuse_tint_map, slot_uv(layer.diffuse_tint_texture)).rgb;
  vec3 coat_texel = detail(coat_normal_map, slot_uv(layer.coat_normal_texture)).xyz;
  SurfaceLayer made =
      surface_layer(layer, texels,
                    mapped_normal(normal, coat_texel, layer.coat_normal_scale,
                                  layer.coat_normal_texture.texture), grain);
  add_diffuse_transmission(layer, texels, made);
  return made;
}
#endif

void main() {
  vec4 color = material.base_color * vertex_color *
               detail(base_color_map, slot_uv(material.base_color_texture));
  vec3 across = cross(dFdy(world_point), dFdx(world_point));
  vec3 vertex_normal = normalize(world_normal);
#ifdef GBUFFER_LAYERED
  ThinFilm film;
  SurfaceLayer extended = layer_here(vertex_normal, film);
  color.a = mix(color.a, 1.0, flag(material.flags, material_whole_alpha)) *
            (1.0 - extended.transmission);
#endif
#ifndef GBUFFER_OPAQUE
  // Of blended surfaces only the opaque part: the rest is blended over the composed frame.
  bool hole = color.a < mix(material.alpha_cutoff, least_solid,
                            flag(material.flags, material_alpha_blend));
#endif
  float side = gl_FrontFacing ? 1.0 : -1.0;
  float area = dot(across, across);
  vec3 geometric = area > 0.0 ? across * inversesqrt(area) : vertex_normal * side;
  if (dot(geometric, vertex_normal) * side < 0.0) geometric = -geometric;
  vec3 texel = detail(normal_map, slot_uv(material.normal_texture)).xyz;
  vec3 shading = mapped_normal(vertex_normal, texel, material.normal_scale,
                               material.normal_texture.texture) * side;
  vec4 packed_surface = detail(metallic_roughness_map,
                                slot_uv(material.metallic_roughness_texture));
  float occlusion = detail(occlusion_map, slot_uv(material.occlusion_texture)).r;

  normals = vec4(octahedral_encode(shading), octahedral_encode(geometric));
  float roughness = material.roughness * packed_surface.g;
  float metallic = material.metallic * packed_surface.b;
  float through = 0.0;
  vec3 base = clamp(color.rgb, 0.0, 1.0);
#ifdef GBUFFER_LAYERED
  extended.coat_normal *= side;
  add_film(film, material_n_dot_v(shading, eye_here()), metallic, extended, base);
  surface_layers = pack_layer(extended, roughness, shading);
  roughness = smoother_roughness(extended, roughness);
  through = extended.diffuse_transmission;
#endif
  base_color = vec4(sqrt(base), mix(1.0, occlusion, material.occlusion_strength));
  surface = vec4(roughness, metallic,
                 flag(material.flags, material_unlit), through);
  vec2 uv_now = clip_now.xy / clip_now.z * 0.5;
  vec2 uv_before = clip_before.xy / clip_before.z * 0.5;
  motion = vec4(uv_before - uv_now, view_depths.y - view_depths.x, exact_view_z(geometric));
  emissive = vec4(material.emissive * detail(emissive_map, slot_uv(material.emissive_texture)).rgb,
                  1.0);
  depth_slope = vec2(dFdx(view_depths.x), dFdy(view_depths.x));
  instance_id = draw.instance + 1u;
#ifndef GBUFFER_OPAQUE
  if (hole) discard;  // last: derivatives beside a lane that has left are undefined
#endif
}
