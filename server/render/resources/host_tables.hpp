#pragma once

#include <array>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "gpu/memory/image.hpp"
#include "render/resources/emissive/emissive_lights.hpp"
#include "render/resources/texture_heap.hpp"
#include "scene/environment.hpp"
#include "shaders/shared/scene.h"
#include "tracing/ray_tracer.hpp"

namespace heliograph::render {
class MovingScene;
class SceneResources;
}  // namespace heliograph::render

/// Tables that shaders look up, as host kernels read them: copies where the device's own may lie
/// anywhere, in an order that vectors of lanes gather from. 32-bit words throughout.
namespace heliograph::render::kernels {

/// A texture of a material, where it lies in the heap included.
struct Slot {
  glm::vec3 row0;  // of the transform
  glm::vec3 row1;
  float lod;  // that the texels of the image and the transform add
  std::uint32_t uv_set;
  std::uint32_t flags;  // texture_*, slot_*
  std::uint32_t width;  // of the largest level
  std::uint32_t height;
  std::uint32_t levels;
  std::uint32_t wrap_s;
  std::uint32_t wrap_t;
  std::uint32_t first_level;  // in LookupTables::levels
  std::uint32_t padding;
};

inline constexpr std::uint32_t slot_used = 1u << 16;
/// Reads the same texels as the slot in front of it.
inline constexpr std::uint32_t slot_repeats = 1u << 17;
/// Is read at the texels at which the record's first slot is, of an image of the same size.
inline constexpr std::uint32_t slot_shares_place = 1u << 18;

struct Material {
  glm::vec4 base_color;
  glm::vec3 emissive;
  float alpha_cutoff;
  float metallic;
  float roughness;
  float normal_scale;
  float occlusion_strength;
  std::uint32_t flags;  // material_*
  std::uint32_t uses;   // uses_*, its layer's included
  std::uint32_t layer;  // in MaterialTable::layers
  float passing;        // fraction of rays that pass where it covers, because light does
  Slot base_color_slot;
  Slot metallic_roughness_slot;
  Slot occlusion_slot;  // after the slot that often has the same image
  Slot normal_slot;
  Slot emissive_slot;
};

inline constexpr std::uint32_t uses_textures = 1u;
inline constexpr std::uint32_t uses_second_uv = 2u;

/// What extensions add to a material, as shared::MaterialLayer has it.
struct Layer {
  glm::vec3 specular_color;
  float specular;
  glm::vec3 sheen;
  float sheen_roughness;
  glm::vec3 absorption;
  float transmission;
  float dielectric;
  float coat;
  float coat_roughness;
  float coat_normal_scale;
  float iridescence;
  float film_ior;
  float film_least;
  float film_thickness;
  float anisotropy;
  float grain_x;
  float grain_y;
  float dispersion;
  glm::vec3 attenuation;
  float refraction;
  glm::vec3 diffuse_tint;
  float diffuse_transmission;
  std::uint32_t uses;  // uses_*
  std::array<std::uint32_t, 3> padding;
  Slot coat_slot;  // whose place the others may share
  Slot coat_roughness_slot;
  Slot coat_normal_slot;
  Slot specular_slot;
  Slot specular_color_slot;
  Slot sheen_color_slot;
  Slot sheen_roughness_slot;
  Slot transmission_slot;
  Slot thickness_slot;
  Slot iridescence_slot;
  Slot film_slot;
  Slot anisotropy_slot;
  Slot diffuse_transmission_slot;
  Slot diffuse_tint_slot;
};

/// What surfaces are made of.
struct MaterialTable {
  std::vector<Material> materials;
  std::vector<Layer> layers;          // the first adds nothing
  std::vector<std::uint32_t> levels;  // first texel of every level of every texture
};

MaterialTable make_material_table(std::span<const shared::Material> materials,
                                  std::span<const shared::MaterialLayer> layers,
                                  std::span<const shared::HeapTexture> textures);

/// The scene's tables in memory, and those made of them.
struct SceneView {
  const shared::Vertex* vertices;
  const std::uint32_t* indices;
  const shared::Mesh* meshes;
  const shared::Instance* instances;
  const Material* materials;
  const Layer* layers;
  const std::uint32_t* levels;
  const std::uint32_t* texels;
  const shared::Vertex* previous_vertices;
  EmissiveView emissive;
};

/// `tables` and `moving` are the scene's in the pose of the frame.
SceneView view_scene(const SceneResources& scene, const tracing::SceneTables& tables,
                     const MovingScene& moving);

/// A grid of `width` x `height` entries of some floats each, row by row.
struct Table {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<float> values;
};

/// An equirectangular map of radiance: three floats a texel, row 0 up.
struct RadianceMap {
  const float* texels;
  int width;
  int height;
};

/// The environment map, for light from infinity.
struct Environment {
  Table map;  // equirectangular; three floats an entry
  RadianceMap radiance() const {
    return {map.values.data(), static_cast<int>(map.width), static_cast<int>(map.height)};
  }
  /// One level of the filtered cube: six faces of four floats a texel, each with a rim of its
  /// neighbours' texels, so that filtering across edges needs no other face.
  struct Level {
    std::uint32_t size;   // without the rim
    std::uint32_t first;  // float of `cube`
  };
  std::vector<Level> levels;
  std::vector<float> cube;
};

/// The environment as it was read, which the result refers to.
RadianceMap view_map(const scene::Environment& environment);

Environment copy_environment(const scene::Environment& map, const gpu::Image& prefiltered);

}  // namespace heliograph::render::kernels
