#include "tracing/bvh/mask_tables.hpp"

#include <span>
#include <string>

#include "shaders/shared/ray_mask.h"
#include "tracing/bvh/alpha_mask.hpp"

namespace heliograph::tracing {
namespace {

template <typename Element>
gpu::Buffer upload(const gpu::Device& device, const std::string& name,
                   const std::vector<Element>& elements) {
  const auto bytes = std::as_bytes(std::span(elements));
  if (bytes.size() > device.limits().maxStorageBufferRange) {
    throw gpu::GpuError("the scene's " + name + " take " + std::to_string(bytes.size()) +
                        " bytes, but the device binds at most " +
                        std::to_string(device.limits().maxStorageBufferRange));
  }
  return gpu::upload_buffer(device, name, bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
}

}  // namespace

MaskTables::MaskTables(const gpu::Device& device, const scene::Scene& scene) {
  std::vector<shared::RayMask> all;
  std::vector<glm::vec2> all_uvs;
  std::vector<std::uint32_t> mask_of_mesh(scene.meshes.size());
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    const scene::Mesh& mesh = scene.meshes[i];
    const shared::Material& material = scene.materials[mesh.material];
    if (coverage(material) != Coverage::masked) continue;
    const AlphaMask mask = make_alpha_mask(mesh, material);
    mask_of_mesh[i] = static_cast<std::uint32_t>(all.size());
    all.push_back({mask.texels, mask.width, mask.height, mask.limit, mask.wrap_s, mask.wrap_t,
                   static_cast<std::uint32_t>(all_uvs.size()), 0});
    all_uvs.insert(all_uvs.end(), mask.uvs.begin(), mask.uvs.end());
  }
  std::vector<std::uint32_t> by_instance;
  by_instance.reserve(scene.instances.size());
  for (const scene::Instance& instance : scene.instances) {
    by_instance.push_back(mask_of_mesh[instance.mesh]);
  }
  mask_of_instance = upload(device, "mask numbers", by_instance);
  masks = upload(device, "ray masks", all);
  uvs = upload(device, "uvs of ray masks", all_uvs);
}

}  // namespace heliograph::tracing
