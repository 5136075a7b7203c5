#include "tracing/device_scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "tracing/bvh/alpha_mask.hpp"

namespace heliograph::tracing {
namespace {

constexpr VkBufferUsageFlags build_input =
    VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR |
    VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;

// VK_KHR_acceleration_structure: a triangle is inactive when x of a vertex is NaN; infinities are
// undefined.
glm::vec3 position_for_build(const shared::Vertex& vertex) {
  const glm::vec3& position = vertex.position;
  if (std::isfinite(glm::dot(position, position))) return position;
  return glm::vec3(std::numeric_limits<float>::quiet_NaN(), 0.0f, 0.0f);
}

/// Concatenated triangles of several meshes.
struct Triangles {
  std::vector<glm::vec3> positions;
  std::vector<std::uint32_t> indices;
  std::vector<DeviceTriangles> meshes;  // addresses are offsets in bytes

  void add(const scene::Mesh& mesh, Coverage seen) {
    DeviceTriangles& added = meshes.emplace_back();
    if (seen == Coverage::none || mesh.indices.size() < 3) return;
    added.positions = positions.size() * sizeof(glm::vec3);
    added.position_count = static_cast<std::uint32_t>(mesh.vertices.size());
    added.indices = indices.size() * sizeof(std::uint32_t);
    added.triangle_count = static_cast<std::uint32_t>(mesh.indices.size() / 3);
    added.masked = seen == Coverage::masked;
    for (const shared::Vertex& vertex : mesh.vertices) {
      positions.push_back(position_for_build(vertex));
    }
    indices.insert(indices.end(), mesh.indices.begin(), mesh.indices.end());
  }

  void move_to(VkDeviceAddress position_buffer, VkDeviceAddress index_buffer) {
    for (DeviceTriangles& mesh : meshes) {
      mesh.positions += position_buffer;
      mesh.indices += index_buffer;
    }
  }
};

Coverage coverage_of(const scene::Scene& scene, const scene::Mesh& mesh) {
  return coverage(scene.materials[mesh.material]);
}

MeshHierarchies build_meshes(const gpu::Device& device, const scene::Scene& scene) {
  Triangles triangles;
  for (const scene::Mesh& mesh : scene.meshes) triangles.add(mesh, coverage_of(scene, mesh));
  const gpu::Buffer positions = gpu::upload_buffer(
      device, "build input positions", std::as_bytes(std::span(triangles.positions)), build_input);
  const gpu::Buffer indices = gpu::upload_buffer(
      device, "build input indices", std::as_bytes(std::span(triangles.indices)), build_input);
  triangles.move_to(positions.address(), indices.address());
  return MeshHierarchies(device, triangles.meshes, Rebuilds::never);
}

}  // namespace

DeviceScene::DeviceScene(const gpu::Device& device, const scene::Scene& scene,
                         std::shared_ptr<const MaskTables> masks, const gpu::Buffer& alpha_heap)
    : masks_(std::move(masks)),
      alpha_heap_(alpha_heap),
      instances_(device, static_cast<std::uint32_t>(scene.instances.size())) {}

void DeviceScene::bind(gpu::FramePlan& plan, gpu::PassBuilder& pass) const {
  pass.read(plan.import(masks_->mask_of_instance))
      .read(plan.import(masks_->masks))
      .read(plan.import(masks_->uvs))
      .read(plan.import(alpha_heap_));
}

StaticDeviceScene::StaticDeviceScene(const gpu::Device& device, const scene::Scene& scene,
                                     const gpu::Buffer& alpha_heap)
    : DeviceScene(device, scene, std::make_shared<const MaskTables>(device, scene), alpha_heap),
      meshes_(std::make_shared<const MeshHierarchies>(build_meshes(device, scene))),
      hidden_(scene.instances.size()) {
  place_instances(device, scene);
}

StaticDeviceScene::StaticDeviceScene(const gpu::Device& device, const StaticDeviceScene& rest,
                                     const scene::Scene& scene, const gpu::Buffer& alpha_heap,
                                     const std::vector<bool>& hidden)
    : DeviceScene(device, scene, rest.masks_, alpha_heap), meshes_(rest.meshes_), hidden_(hidden) {
  place_instances(device, scene);
}

void StaticDeviceScene::place_instances(const gpu::Device& device, const scene::Scene& scene) {
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const auto& [mesh, node] = scene.instances[i];
    instances_.place(i, hidden_[i] ? 0 : meshes_->address(mesh), scene.nodes[node].world);
  }
  device.submit_once([&](VkCommandBuffer commands) { instances_.record_build(commands); });
}

MovingDeviceScene::MovingDeviceScene(const gpu::Device& device,
                                     std::shared_ptr<const StaticDeviceScene> rest,
                                     const scene::Scene& scene, const gpu::Buffer& alpha_heap)
    : DeviceScene(device, scene, rest->masks(), alpha_heap),
      device_(device),
      rest_(std::move(rest)),
      deforming_(scene.meshes.size(), rigid) {
  Triangles triangles;
  for (const scene::Deformation& deformation : scene.deformations) {
    const scene::Mesh& mesh = scene.meshes[deformation.mesh];
    deforming_[deformation.mesh] = triangles.meshes.size();
    first_position_.push_back(triangles.positions.size());
    triangles.add(mesh, coverage_of(scene, mesh));
  }
  const auto positions = std::as_bytes(std::span(triangles.positions));
  positions_ = gpu::Buffer(device, "deforming positions", positions.size(), build_input,
                           gpu::Memory::upload);
  std::copy(positions.begin(), positions.end(), positions_.mapped());
  indices_ = gpu::upload_buffer(device, "deforming indices",
                                std::as_bytes(std::span(triangles.indices)), build_input);
  triangles.move_to(positions_.address(), indices_.address());
  meshes_ = MeshHierarchies(device, triangles.meshes, Rebuilds::often);
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const auto& [mesh, node] = scene.instances[i];
    const VkDeviceAddress address = deforming_[mesh] == rigid ? rest_->meshes().address(mesh)
                                                              : meshes_.address(deforming_[mesh]);
    mesh_addresses_.push_back(rest_->hidden()[i] ? 0 : address);
    instances_.place(i, mesh_addresses_[i], scene.nodes[node].world);
  }
  device.submit_once([&](VkCommandBuffer commands) { instances_.record_build(commands); });
}

void MovingDeviceScene::update(const Movement& movement) {
  if (movement.deformed.empty() && movement.moved.empty()) return;
  std::vector<std::size_t> changed;
  for (const Movement::Mesh& mesh : movement.deformed) {
    const std::size_t slot = deforming_[mesh.mesh];
    changed.push_back(slot);
    // Meshes without triangles have no positions here.
    if (meshes_.address(slot) == 0) continue;
    std::transform(mesh.vertices.begin(), mesh.vertices.end(),
                   reinterpret_cast<glm::vec3*>(positions_.mapped()) + first_position_[slot],
                   position_for_build);
  }
  for (const std::uint32_t i : movement.moved) {
    instances_.place(i, mesh_addresses_[i], movement.worlds[i]);
  }
  device_.submit_once([&](VkCommandBuffer commands) {
    if (!changed.empty()) meshes_.record_rebuild(commands, changed);
    instances_.record_build(commands);
  });
}

}  // namespace heliograph::tracing
