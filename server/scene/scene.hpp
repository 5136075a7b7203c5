#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scene/import_limits.hpp"
#include "scene/shared_list.hpp"
#include "scene/source_file.hpp"
#include "scene/texture_override.hpp"
#include "shaders/shared/scene.h"

namespace heliograph::scene {

struct Environment;

struct Bounds {
  glm::vec3 minimum{1e30f};
  glm::vec3 maximum{-1e30f};
  bool empty() const { return minimum.x > maximum.x; }
  glm::vec3 center() const { return 0.5f * (minimum + maximum); }
  float radius() const { return empty() ? 1.0f : 0.5f * glm::length(maximum - minimum); }
  void include(const glm::vec3& point);
  void include(const Bounds& other);
};

/// A box around a box of a mesh's space, in the world; empty for an empty one.
Bounds world_bounds(const Bounds& mesh, const glm::mat4& world);

/// By how much `world` makes lengths larger: the edge of the cube into whose volume it makes a cube
/// of edge 1. Of a scale that is the same along all axes it is that scale. KHR_materials_volume
/// gives thicknesses no direction along which to measure others.
float length_scale(const glm::mat4& world);

/// RGBA8 pixels, top row first; mip levels in order, the last is 1x1. `srgb`: color channels are
/// sRGB encoded; mips were filtered in linear space. `pixels` may be released after upload;
/// ImagePixels decodes them again.
struct Image {
  std::string name;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t levels = 1;
  bool srgb = false;
  std::vector<std::uint8_t> pixels;
  std::shared_ptr<const std::vector<std::uint8_t>> file =
      nullptr;           // encoded file, for decoding again
  bool damaged = false;  // missing or damaged: one white texel takes its place
};

enum class Filter { nearest, linear };

struct Sampler {
  std::uint32_t wrap_s = shared::wrap_repeat;
  std::uint32_t wrap_t = shared::wrap_repeat;
  Filter magnify = Filter::linear;
  Filter minify = Filter::linear;
  bool mipmapped = true;
  Filter mip_filter = Filter::linear;
  bool operator==(const Sampler&) const = default;
};

struct Texture {
  std::uint32_t image = 0;
  Sampler sampler;
};

struct Mesh {
  std::string name;
  std::vector<shared::Vertex> vertices;  // in the default pose
  std::vector<std::uint32_t> indices;    // triangles, counter-clockwise from outside
  std::uint32_t material = 0;
  Bounds bounds;  // mesh space
};

struct Transform {
  glm::vec3 translation{0.0f};
  glm::quat rotation{1.0f, 0.0f, 0.0f, 0.0f};  // unit length
  glm::vec3 scale{1.0f};

  glm::mat4 matrix() const;
};

struct Node {
  std::string name;
  std::optional<std::uint32_t> parent;  // always a smaller index: parents come first
  glm::mat4 local{1.0f};
  glm::mat4 world{1.0f};
  std::optional<Transform> transform = std::nullopt;  // of `local`, unless the file has a matrix
  std::vector<float> weights = {};                    // default weights of its mesh's morph targets
  bool visible = true;  // without a clip, with all below it; false only where a clip may show it
};

/// One mesh placed in the world by a node. Deforming meshes have one instance each, skinned ones a
/// node of their own at the origin: their vertices follow joints only (glTF 3.7.3.3).
struct Instance {
  std::uint32_t mesh = 0;
  std::uint32_t node = 0;
};

struct Camera {
  std::string name;
  glm::vec3 eye{0.0f, 0.0f, 1.0f};
  glm::vec3 target{0.0f};
  glm::vec3 up{0.0f, 1.0f, 0.0f};
  float vertical_fov = 45.0f;        // degrees; perspective
  float orthographic_height = 0.0f;  // metres, full height; 0: perspective
  float near_plane = 0.05f;          // metres
  float far_plane = 1000.0f;         // metres; orthographic only, perspective has none
  std::optional<std::uint32_t> node = std::nullopt;  // parent node
  std::uint32_t number = 0;                          // in the file
};

/// What the file says of a punctual light (KHR_lights_punctual) that its device form has in
/// combination only.
struct PunctualLight {
  std::uint32_t number = 0;  // in the file
  glm::vec3 color{1.0f};
  float intensity = 1.0f;
};

/// A light with its world-space device form and the name of its node.
struct Light {
  std::string name;
  shared::Light device;
  float angular_diameter = 0.0f;                     // degrees, directional only
  std::optional<std::uint32_t> node = std::nullopt;  // parent node
  std::optional<PunctualLight> punctual = std::nullopt;
};

/// Displacements of the vertices of a shape; an empty list displaces nothing.
struct MorphTarget {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;
  std::vector<glm::vec3> tangents;
};

/// A joint of a skin and its weight for a vertex.
struct JointWeight {
  std::uint32_t joint = 0;  // index within the skin
  float weight = 0.0f;
};

/// Source of a deforming mesh: its vertices before morph targets and joints.
struct Shape {
  std::vector<shared::Vertex> vertices;
  std::vector<MorphTarget> targets;
  std::uint32_t joints_per_vertex = 0;  // 0: not skinned
  std::vector<JointWeight> influences;  // joints_per_vertex for every vertex; weights sum to 1
  bool flat = false;  // no normals in the file: face normals, three vertices per triangle
};

struct Skin {
  std::vector<std::uint32_t> joints;    // nodes
  std::vector<glm::mat4> inverse_bind;  // scene -> joint, of every joint
};

/// A mesh that deforms: first morph targets, then joints.
struct Deformation {
  std::uint32_t mesh = 0;
  std::uint32_t shape = 0;
  std::uint32_t node = 0;  // node with the morph weights
  std::optional<std::uint32_t> skin;
};

/// An empty texture slot.
inline shared::TextureSlot no_texture_slot() {
  return {.transform_row0 = {1.0f, 0.0f, 0.0f, 0.0f},
          .transform_row1 = {0.0f, 1.0f, 0.0f, 0.0f},
          .texture = shared::no_texture,
          .uv_set = 0,
          .padding0 = 0,
          .padding1 = 0};
}

/// KHR_texture_transform.
struct TextureTransform {
  glm::vec2 offset{0.0f};
  float rotation = 0.0f;  // radians, counter-clockwise with v pointing down
  glm::vec2 scale{1.0f};

  void apply(shared::TextureSlot& slot) const;
};

/// Values of material extensions beyond metallic-roughness; defaults are neutral.
struct MaterialLayers {
  glm::vec3 emissive_factor{0.0f};  // shared::Material::emissive is the product
  float emissive_strength = 1.0f;   // KHR_materials_emissive_strength
  float specular = 1.0f;            // KHR_materials_specular
  glm::vec3 specular_color{1.0f};
  float clearcoat = 0.0f;
  float clearcoat_roughness = 0.0f;
  float clearcoat_normal_scale = 1.0f;
  glm::vec3 sheen_color{0.0f};
  float sheen_roughness = 0.0f;
  float transmission = 0.0f;
  float thickness = 0.0f;             // in the mesh's space, times length_scale() metres; 0: a
                                      // thin wall
  float attenuation_distance = 0.0f;  // metres; 0: infinite
  glm::vec3 attenuation_color{1.0f};
  float dispersion = 0.0f;  // 20 / Abbe number
  float iridescence = 0.0f;
  float iridescence_ior = 1.3f;
  float iridescence_thickness_minimum = 100.0f;  // nanometres
  float iridescence_thickness_maximum = 400.0f;
  float anisotropy = 0.0f;
  float anisotropy_rotation = 0.0f;  // radians, from the tangent toward the bitangent
  float diffuse_transmission = 0.0f;
  glm::vec3 diffuse_transmission_color{1.0f};

  shared::TextureSlot specular_texture = no_texture_slot();
  shared::TextureSlot specular_color_texture = no_texture_slot();
  shared::TextureSlot clearcoat_texture = no_texture_slot();
  shared::TextureSlot clearcoat_roughness_texture = no_texture_slot();
  shared::TextureSlot clearcoat_normal_texture = no_texture_slot();
  shared::TextureSlot sheen_color_texture = no_texture_slot();
  shared::TextureSlot sheen_roughness_texture = no_texture_slot();
  shared::TextureSlot transmission_texture = no_texture_slot();
  shared::TextureSlot thickness_texture = no_texture_slot();
  shared::TextureSlot iridescence_texture = no_texture_slot();
  shared::TextureSlot iridescence_thickness_texture = no_texture_slot();
  shared::TextureSlot anisotropy_texture = no_texture_slot();
  shared::TextureSlot diffuse_transmission_texture = no_texture_slot();
  shared::TextureSlot diffuse_transmission_color_texture = no_texture_slot();
};

enum class Interpolation { step, linear, cubic_spline };
enum class Property { translation, rotation, scale, weights };

/// Properties that clips animate by pointers, beside those of nodes (KHR_animation_pointer).
enum class PointedProperty {
  visible,  // of nodes
  light_color,
  light_intensity,
  light_range,
  inner_cone,
  outer_cone,
  vertical_fov,  // of cameras
  orthographic_height,
  base_color,
  metallic,
  roughness,
  emissive,
  emissive_strength,
  normal_scale,
  occlusion_strength,
  ior,
  specular,
  specular_color,
  clearcoat,
  clearcoat_roughness,
  clearcoat_normal_scale,
  sheen_color,
  sheen_roughness,
  transmission,
  thickness,
  attenuation_distance,
  attenuation_color,
  dispersion,
  iridescence,
  iridescence_ior,
  iridescence_thickness_minimum,
  iridescence_thickness_maximum,
  anisotropy,
  anisotropy_rotation,
  diffuse_transmission,
  diffuse_transmission_color,
  texture_offset,
  texture_rotation,
  texture_scale,
};

/// A value over time: keys, and what is between them.
struct Curve {
  Interpolation interpolation = Interpolation::linear;
  std::uint32_t width = 3;        // numbers per value
  std::vector<float> times = {};  // seconds, ascending
  /// Per key one value; cubic spline: in-tangent, value, out-tangent.
  std::vector<float> values = {};
};

/// One animated property of a node.
struct Channel : Curve {
  std::uint32_t node = 0;
  Property property = Property::translation;
};

/// One animated property of another kind.
struct Track : Curve {
  PointedProperty property = PointedProperty::visible;
  /// A node or material of the scene, an AnimatedSlot for texture transforms, or the number that a
  /// light or camera has in the file.
  std::uint32_t object = 0;
};

/// A texture slot of a material whose transform a clip animates.
struct AnimatedSlot {
  std::uint32_t material = 0;
  std::uint32_t kind = 0;      // in texture_kinds()
  TextureTransform transform;  // of the file
};

struct Clip {
  std::string name;
  float duration = 0.0f;  // seconds: its last key
  std::vector<Channel> channels;
  std::vector<Track> tracks = {};
};

/// A whole glTF scene, validated, ready for upload. Immutable once loaded. A scene that is shown
/// before its images are decoded shares its lists with the whole one.
struct Scene {
  std::string name;
  SharedList<Node> nodes;
  SharedList<Mesh> meshes;
  std::vector<std::string> material_names;
  std::vector<shared::Material> materials;      // at least one
  std::vector<MaterialLayers> material_layers;  // per material, as in the file
  std::vector<shared::MaterialLayer> layers;    // for shading; the first is glTF's base model
  std::vector<std::string> variants;            // KHR_materials_variants
  std::optional<std::uint32_t> variant;         // selected variant; nullopt: the file's default
  std::vector<std::string> scenes;              // names of the file's scenes; a name may be empty
  std::uint32_t shown_scene = 0;                // index of this scene
  SceneChoice choice;                           // as the import was asked for it
  std::vector<Image> images;
  std::vector<Texture> textures;
  std::vector<ReplacedTexture> replaced_textures;  // which the import was told to replace
  std::vector<std::uint8_t> alpha_heap;  // alpha of masked base colors, one byte per texel
  std::vector<Instance> instances;
  std::vector<Camera> cameras;
  std::vector<Light> lights;
  std::shared_ptr<const Environment> environment;  // of EXT_lights_image_based; null: none
  SharedList<Shape> shapes;
  SharedList<Skin> skins;
  std::vector<Deformation> deformations;
  SharedList<Clip> clips;
  std::vector<AnimatedSlot> animated_slots;
  Bounds bounds;  // world space
  std::vector<std::string> warnings;
  std::vector<SourceFile> sources;  // all files read, the scene's own first

  std::uint64_t triangle_count() const;  // of all instances
  std::uint64_t bytes() const;           // memory of vertices, images, curves and its environment
};

}  // namespace heliograph::scene
