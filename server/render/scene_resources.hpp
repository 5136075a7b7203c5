#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "render/host_tables.hpp"
#include "render/lit_environment.hpp"
#include "render/renderer.hpp"
#include "render/texture_heap.hpp"
#include "tracing/ray_tracer.hpp"

namespace heliograph::render {

/// One instance as the rasteriser draws it.
struct Draw {
  shared::DrawConstants constants;
  std::uint32_t material;
  std::uint32_t first_index;
  std::uint32_t index_count;
  std::uint32_t first_vertex;
  // Where its vertices of the frame before start among those of all meshes that deform.
  std::optional<std::uint32_t> previous_vertex;
  bool masked;  // alpha mask or blend: the program that discards
  bool double_sided;
  bool flipped;
  scene::Bounds bounds;  // world
};

class SceneResources {
 public:
  SceneResources(const gpu::Device& device, const Programs& programs,
                 std::shared_ptr<const scene::Scene> scene,
                 std::shared_ptr<const LitEnvironment> environment,
                 const tracing::RayTracer& tracer, const UploadProgress& progress);

  /// Memory of tables, images and the acceleration structure.
  std::uint64_t bytes() const;

  std::shared_ptr<const scene::Scene> scene;
  tracing::SceneBuffers rest_tables;
  std::shared_ptr<const tracing::AccelerationStructure> rest_structure;
  std::shared_ptr<const LitEnvironment> environment;
  TextureHeap texture_heap;
  host::MaterialTable host_materials;  // on devices that are processors
  std::uint32_t features = 0;  // shared::scene_*
  std::vector<Draw> draws;     // opaque first, then by material
  std::uint32_t deforming_vertices = 0;
  std::vector<VkDescriptorSet> material_sets;

 private:
  void upload_tables(const gpu::Device& device);
  void upload_textures(const gpu::Device& device, const UploadProgress& progress);
  void make_material_sets(const gpu::Device& device, const Programs& programs);
  void list_draws();

  std::vector<shared::Mesh> meshes_;
  std::vector<shared::Instance> instances_;
  std::vector<gpu::Image> images_;
  gpu::Image white_;
  gpu::Image flat_normal_;
  std::vector<gpu::Sampler> samplers_;
  std::vector<std::uint32_t> texture_sampler_;  // by texture, into samplers_
  gpu::Buffer material_blocks_;  // shared::Material each, at the device's uniform alignment
  std::unique_ptr<gpu::DescriptorPool> pool_;
};

}  // namespace heliograph::render
