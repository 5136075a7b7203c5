// What a scene looks like to the device: std430 layouts, the same bytes in C++.
#ifndef HELIOGRAPH_SHARED_SCENE_H
#define HELIOGRAPH_SHARED_SCENE_H
#include "types.h"
SHARED_BEGIN

SHARED_CONSTANT uint no_texture = 0xffffffffu;

// 64 bytes. Positions and normals are in mesh space; tangent.w is the bitangent's sign
// (glTF 3.7.2).
struct Vertex {
  vec3 position;
  uint color_rg;  // linear vertex colour, packUnorm2x16
  vec3 normal;
  uint color_ba;
  vec4 tangent;
  vec2 uv0;
  vec2 uv1;
};

SHARED_CONSTANT uint material_alpha_mask = 1u;
SHARED_CONSTANT uint material_alpha_blend = 2u;
SHARED_CONSTANT uint material_double_sided = 4u;
SHARED_CONSTANT uint material_unlit = 8u;
SHARED_CONSTANT uint material_whole_alpha = 16u;  // alpha is 1, whatever textures and vertices say

// A texture slot: `uv = transform * (uvN, 1)` with the rows of KHR_texture_transform's 2x3 matrix.
struct TextureSlot {
  vec4 transform_row0;  // xyz: first row; w: unused
  vec4 transform_row1;  // xyz: second row; w: unused
  uint texture;         // index into the scene's textures, or no_texture
  uint uv_set;          // 0 or 1
  uint padding0;
  uint padding1;
};

// Blended surfaces that cover so much are drawn like others.
SHARED_CONSTANT float least_solid = 0.998;

// What extensions add to a material: factors, then their textures. The first of a scene adds
// nothing.
struct MaterialLayer {
  vec3 specular_color;
  float specular;
  vec3 sheen;
  float sheen_roughness;
  vec3 absorption;  // of light that passes: exponents, after the whole thickness in mesh space
  float transmission;
  float dielectric;  // reflectance by the index of refraction, head on
  float coat;        // fraction of the surface that lies under a clear coat
  float coat_roughness;
  float coat_normal_scale;
  float iridescence;     // fraction of the surface that lies under a thin film
  float film_ior;        // its index of refraction
  float film_least;      // its thickness where the texture is 0, nanometres
  float film_thickness;  // and where it is 1
  float anisotropy;      // strength
  float grain_x;         // direction in which the surface is rougher, in its tangent plane
  float grain_y;
  float dispersion;              // 20 / Abbe number
  vec3 attenuation;              // of light within the volume: exponents, per metre
  float refraction;              // index of refraction of the volume; 0: the surface is a thin wall
  vec3 diffuse_tint;             // of the diffuse light that leaves at the other side
  float diffuse_transmission;    // how much of it does
  TextureSlot specular_texture;  // a
  TextureSlot specular_color_texture;  // rgb
  TextureSlot coat_texture;            // r
  TextureSlot coat_roughness_texture;  // g
  TextureSlot coat_normal_texture;
  TextureSlot sheen_color_texture;           // rgb
  TextureSlot sheen_roughness_texture;       // a
  TextureSlot transmission_texture;          // r
  TextureSlot thickness_texture;             // g
  TextureSlot iridescence_texture;           // r
  TextureSlot film_texture;                  // g: the film's thickness
  TextureSlot anisotropy_texture;            // rg: direction, b: strength
  TextureSlot diffuse_transmission_texture;  // a
  TextureSlot diffuse_tint_texture;          // rgb
};
SHARED_CONSTANT uint layer_textures = 14u;

// glTF 2.0 metallic-roughness material; factors are linear.
struct Material {
  vec4 base_color;
  vec3 emissive;  // factor x KHR_materials_emissive_strength, radiance in scene units
  float alpha_cutoff;
  float metallic;
  float roughness;  // perceptual
  float normal_scale;
  float occlusion_strength;
  float ior;  // 1.5 unless KHR_materials_ior
  uint flags;
  uint alpha_mask;       // offset in bytes into the alpha heap read by rays, or no_texture
  uint alpha_mask_size;  // width | height << 16
  uint alpha_mask_wrap;  // wrap_s | wrap_t << 8, values of Wrap
  uint layer;            // its MaterialLayer's number
  float passing;         // fraction of rays that pass where it covers, because light does
  uint padding0;
  TextureSlot base_color_texture;
  TextureSlot metallic_roughness_texture;
  TextureSlot normal_texture;
  TextureSlot occlusion_texture;
  TextureSlot emissive_texture;
};

SHARED_CONSTANT uint wrap_repeat = 0u;
SHARED_CONSTANT uint wrap_clamp = 1u;
SHARED_CONSTANT uint wrap_mirror = 2u;

// One glTF primitive: a range of the scene's vertex and index buffers with one material.
struct Mesh {
  uint first_index;
  uint index_count;
  uint first_vertex;
  uint material;
};

struct Instance {
  mat4 world;           // mesh -> world
  mat4 previous_world;  // the same, one rendered frame ago
  mat4 normal_matrix;   // inverse transpose of world's upper 3x3
  uint mesh;
  uint flags;  // instance_flipped where world changes the handedness (negative determinant)
  uint previous_vertex;  // its mesh's first vertex among those of the frame before, + 1; 0: the
                         // mesh keeps its shape
  float scale;           // mesh -> world, of the thickness of volumes
};
SHARED_CONSTANT uint instance_flipped = 1u;

// What one draw of the G-buffer needs of its instance: push constants, because lavapipe reads
// storage buffers lane by lane. Rows of the matrices.
struct DrawConstants {
  vec4 world[3];
  vec4 previous_world[3];
  uint instance;
  uint flags;
  float scale;
};

// So many lights are read from a uniform block, which is fastest and holds 16 KiB on every device;
// those after them from texels.
SHARED_CONSTANT uint uniform_lights = 192u;
SHARED_CONSTANT uint texels_per_light = 5u;

// What a scene has: bits of the constant that its shaders are specialised with.
SHARED_CONSTANT uint scene_area_lights = 1u;
SHARED_CONSTANT uint scene_many_lights = 2u;  // more than uniform_lights
SHARED_CONSTANT uint scene_deforms = 4u;
SHARED_CONSTANT uint scene_blends = 8u;       // has surfaces of partial coverage
SHARED_CONSTANT uint scene_layers = 16u;      // has materials with layers other than the first
SHARED_CONSTANT uint scene_emissive = 32u;    // has emissive triangles
SHARED_CONSTANT uint scene_light_grid = 64u;  // has so many punctual lights (light_grid.h)
SHARED_CONSTANT uint scene_transmits = 128u;  // has surfaces that light passes
SHARED_CONSTANT uint scene_diffuse_transmits = 256u;  // has surfaces that scatter light to their
                                                      // other side
SHARED_CONSTANT uint scene_disperses = 512u;  // has volumes that split light into its colours

SHARED_CONSTANT uint light_directional = 0u;
SHARED_CONSTANT uint light_point = 1u;
SHARED_CONSTANT uint light_spot = 2u;
SHARED_CONSTANT uint light_rectangle = 3u;  // this and all after it have an area that shines
SHARED_CONSTANT uint light_disk = 4u;

// KHR_lights_punctual and area lights, in world space.
struct Light {
  vec3 position;  // of the middle
  uint type;
  vec3 direction;     // in which light travels, unit length; an area light shines on this side
  float range;        // metres; 0: unlimited
  vec3 color;         // linear colour x intensity: irradiance (directional), radiant intensity
                      // (point, spot) or radiance (area)
  float radius;       // metres (point, spot, disk; rectangle: of a disk as large) or tangent of the
                      // angular radius (directional)
  vec3 tangent;       // along a rectangle's width, unit length
  float half_width;   // metres
  float half_height;  // along cross(direction, tangent)
  float spot_scale;   // KHR_lights_punctual's lightAngleScale
  float spot_offset;  // and lightAngleOffset
  float padding0;
};

SHARED_END
#endif
