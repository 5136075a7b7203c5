#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "render/api/engine.hpp"
#include "render/resources/draw.hpp"
#include "render/resources/emissive/emissive_lights.hpp"
#include "render/resources/environment/lit_environment.hpp"
#include "render/resources/host_tables.hpp"
#include "render/resources/texture_heap.hpp"
#include "tracing/ray_tracer.hpp"

namespace heliograph::render {

/// Materials, and what Material::layer counts.
struct MaterialTables {
  std::span<const shared::Material> materials;
  std::span<const shared::MaterialLayer> layers;
};

/// Materials as the rasteriser reads them: a uniform block and a descriptor set each.
struct MaterialSets {
  gpu::Buffer blocks;        // shared::Material each, `stride` bytes apart
  gpu::Buffer layer_blocks;  // the shared::MaterialLayer of each likewise; empty: without layers
  VkDeviceSize stride = 0;
  VkDeviceSize layer_stride = 0;
  std::unique_ptr<gpu::DescriptorPool> pool;
  std::vector<VkDescriptorSet> sets;
  std::vector<std::uint32_t> textures;  // of all slots, set by set

  /// Never while a frame runs; only where the blocks are memory that the host reaches.
  /// @return whether the sets suit: nothing is written where textures differ
  bool write(const MaterialTables& tables) const;
};

/// Called for every image whose pixels are not needed any more.
using ImageDone = std::function<void(std::size_t image)>;

struct UploadChoices {
  bool host_kernels;         // passes that have one run theirs, so that no shader reads the scene
  bool compressed_textures;  // of KTX2 files stay compressed, for samplers
};

class SceneResources {
 public:
  /// `first`: of the same scene without its textures, on the same device: its tables of geometry
  /// are shared, as is its acceleration structure where rays meet the same; nothing else of it
  /// stays otherwise. Null: there is none.
  SceneResources(const gpu::Device& device, const Programs& programs, UploadChoices choices,
                 std::shared_ptr<const scene::Scene> scene,
                 std::shared_ptr<const LitEnvironment> environment,
                 const tracing::RayTracer& tracer, const UploadProgress& progress,
                 const ImageDone& image_done,
                 const std::shared_ptr<const SceneResources>& first = nullptr);

  /// Memory of tables, images and the acceleration structure, with all that is shared.
  std::uint64_t bytes() const;

  std::shared_ptr<const scene::Scene> scene;
  tracing::SceneBuffers rest_tables;
  std::shared_ptr<const tracing::AccelerationStructure> rest_structure;
  std::shared_ptr<const LitEnvironment> environment;
  TextureHeap texture_heap;
  gpu::Buffer layers;  // shared::MaterialLayer each
  EmissionMeans emission_means;
  EmissiveBuffers emissive;               // in the default pose
  float emissive_power = 0.0f;            // shared::EmissiveHeader::power of it
  kernels::MaterialTable host_materials;  // on devices that are processors
  std::uint32_t features = 0;             // shared::scene_*
  /// Vertices or indices take more memory than shaders of this device can bind.
  bool for_kernels_only = false;
  std::vector<Draw> draws;  // opaque first, then by material
  std::uint32_t deforming_vertices = 0;

  /// What the rasteriser reads. On processors, where rays find most G-buffers, images that samplers
  /// read are made at the first call of either: they take as much memory as the heap. Thread safe.
  const MaterialSets& material_sets() const;
  /// Other values for the scene's materials, with its textures; `layered`: the sets are for shaders
  /// of scenes with layers. The host's only on processors.
  MaterialSets make_material_sets(const MaterialTables& tables, bool layered,
                                  gpu::Memory memory) const;
  kernels::MaterialTable make_host_materials(const MaterialTables& tables) const;

 private:
  /// Tables that a scene has in common with its first view.
  struct Geometry {
    gpu::Buffer vertices;
    gpu::Buffer indices;
    gpu::Buffer meshes;
    gpu::Buffer instances;
  };

  void upload_tables(const gpu::Device& device, bool host_kernels, const SceneResources* first);
  std::shared_ptr<const Geometry> upload_geometry(const gpu::Device& device) const;
  void bind_geometry();
  void share_structure(const std::shared_ptr<const SceneResources>& first);
  std::uint64_t bytes_of_its_own() const;
  void upload_textures(const UploadProgress& progress, const ImageDone& image_done);
  void upload_emissive_triangles();
  void make_samplers();
  void list_draws();
  void make_missing_images() const;
  void add_sampled_texture(const scene::Image& image, std::span<const std::uint8_t> pixels) const;

  void write_slots(gpu::DescriptorWriter& writer, std::uint32_t first_binding,
                   std::span<const shared::TextureSlot* const> slots,
                   const shared::TextureSlot* normal) const;

  const gpu::Device& device_;
  const Programs& programs_;
  const bool compressed_textures_;
  std::shared_ptr<const Geometry> geometry_;
  std::uint64_t first_bytes_ = 0;  // of a first view that stays with the structure
  std::vector<shared::Mesh> meshes_;
  std::vector<shared::Instance> instances_;
  mutable std::mutex sampled_mutex_;        // guards the two below
  mutable std::vector<gpu::Image> images_;  // of the scene, as far as they are made
  mutable std::optional<MaterialSets> material_sets_;
  gpu::Image white_;
  gpu::Image flat_normal_;
  std::vector<gpu::Sampler> samplers_;
  std::vector<std::uint32_t> texture_sampler_;  // by texture, into samplers_
};

}  // namespace heliograph::render
