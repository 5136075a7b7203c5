#include "render/resources/moving/moving_parts.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>

#include "render/resources/moving/writable_table.hpp"
#include "render/resources/placement.hpp"
#include "scene/animation/deform.hpp"

namespace heliograph::render {
namespace {

std::vector<shared::Vertex> all_vertices(const scene::Scene& scene) {
  std::vector<shared::Vertex> vertices;
  for (const scene::Mesh& mesh : scene.meshes) {
    vertices.insert(vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
  }
  return vertices;
}

}  // namespace

MovingParts::MovingParts(const gpu::Device& device, const scene::Scene& scene,
                         const std::vector<Draw>& draws)
    : draws_(draws), draw_of_(scene.instances.size()) {
  for (const scene::Instance& instance : scene.instances) {
    worlds_.push_back(scene.nodes[instance.node].world);
    instances_.push_back(place_mesh(instance.mesh, worlds_.back()));
  }
  for (const scene::Mesh& mesh : scene.meshes) bounds_.push_back(mesh.bounds);
  for (std::uint32_t i = 0; i < draws_.size(); ++i) draw_of_[draws_[i].constants.instance] = i;
  instance_table_ =
      writable_table(device, "instances now", std::span<const shared::Instance>(instances_),
                     VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  if (!scene.deformations.empty()) make_vertex_tables(device, scene);
}

void MovingParts::make_vertex_tables(const gpu::Device& device, const scene::Scene& scene) {
  std::vector<std::size_t> first_vertex;
  std::size_t count = 0;
  for (const scene::Mesh& mesh : scene.meshes) {
    first_vertex.push_back(count);
    count += mesh.vertices.size();
  }
  std::vector<shared::Vertex> previous;
  for (const scene::Deformation& deformation : scene.deformations) {
    const scene::Mesh& mesh = scene.meshes[deformation.mesh];
    deforming_.push_back({mesh.vertices, mesh.bounds, deformation.mesh,
                          first_vertex[deformation.mesh], previous.size()});
    previous.insert(previous.end(), mesh.vertices.begin(), mesh.vertices.end());
  }
  const std::vector<shared::Vertex> all = all_vertices(scene);
  vertex_table_ =
      writable_table(device, "vertices now", std::span(all),
                     VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
  previous_table_ =
      writable_table(device, "vertices before", std::span<const shared::Vertex>(previous),
                     VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
  for (const Deforming& mesh : deforming_) {
    for (shared::Instance& instance : instances_) {
      if (instance.mesh != mesh.mesh) continue;
      instance.previous_vertex = static_cast<std::uint32_t>(mesh.previous_vertex) + 1;
    }
  }
  std::memcpy(instance_table_.mapped(), instances_.data(), std::span(instances_).size_bytes());
}

bool MovingParts::move(const scene::Scene& scene, const scene::Pose& before,
                       const scene::Pose& pose) {
  const bool instances = move_instances(scene, pose);
  const bool shapes = deform(scene, before, pose);
  move_draws(scene);
  update_structure();
  return instances || shapes;
}

bool MovingParts::settled() const {
  return placed_.empty() && std::ranges::none_of(deforming_, &Deforming::moved);
}

bool MovingParts::move_instances(const scene::Scene& scene, const scene::Pose& pose) {
  moved_.clear();
  placed_.clear();
  auto* const table = reinterpret_cast<shared::Instance*>(instance_table_.mapped());
  for (std::uint32_t i = 0; i < instances_.size(); ++i) {
    shared::Instance& instance = instances_[i];
    const glm::mat4& world = pose.worlds[scene.instances[i].node];
    const bool moves = world != instance.world;
    if (!moves && instance.previous_world == instance.world) continue;
    move_instance(instance, world);
    table[i] = instance;
    moved_.push_back(i);
    if (!moves) continue;
    placed_.push_back(i);
    worlds_[i] = world;
  }
  return !moved_.empty();
}

bool MovingParts::deform(const scene::Scene& scene, const scene::Pose& before,
                         const scene::Pose& pose) {
  auto* const table = reinterpret_cast<shared::Vertex*>(vertex_table_.mapped());
  auto* const previous = reinterpret_cast<shared::Vertex*>(previous_table_.mapped());
  tbb::parallel_for(std::size_t(0), deforming_.size(), [&](std::size_t i) {
    const scene::Deformation& deformation = scene.deformations[i];
    Deforming& mesh = deforming_[i];
    mesh.moved_before = mesh.moved;
    mesh.moved = scene::shape_differs(scene, deformation, before, pose);
    if (mesh.moved || mesh.moved_before) {
      std::ranges::copy(mesh.vertices, previous + mesh.previous_vertex);
    }
    if (!mesh.moved) return;
    mesh.bounds = scene::deform(scene, deformation, pose, mesh.vertices);
    bounds_[deformation.mesh] = mesh.bounds;
    std::ranges::copy(mesh.vertices, table + mesh.first_vertex);
  });
  return std::ranges::any_of(deforming_,
                             [](const Deforming& mesh) { return mesh.moved || mesh.moved_before; });
}

void MovingParts::move_draws(const scene::Scene& scene) {
  const auto move = [&](std::uint32_t instance) {
    Draw& draw = draws_[draw_of_[instance]];
    draw.constants = draw_constants(instances_[instance], instance);
    draw.flipped = instances_[instance].flags & shared::instance_flipped;
    draw.bounds = scene::world_bounds(bounds_[scene.instances[instance].mesh], worlds_[instance]);
  };
  for (const std::uint32_t instance : moved_) move(instance);
  if (deforming_.empty()) return;
  for (std::uint32_t i = 0; i < instances_.size(); ++i) {
    if (draws_[draw_of_[i]].previous_vertex) move(i);
  }
}

void MovingParts::update_structure() {
  std::vector<tracing::Movement::Mesh> meshes;
  for (const Deforming& mesh : deforming_) {
    if (mesh.moved) meshes.push_back({mesh.mesh, mesh.vertices, mesh.bounds});
  }
  structure_->update({worlds_, placed_, meshes});
}

void MovingParts::set_structure(std::unique_ptr<tracing::MovingStructure> structure,
                                const scene::Scene& scene) {
  structure_ = std::move(structure);
  std::vector<std::uint32_t> elsewhere;
  for (std::uint32_t i = 0; i < worlds_.size(); ++i) {
    if (worlds_[i] != scene.nodes[scene.instances[i].node].world) elsewhere.push_back(i);
  }
  std::vector<tracing::Movement::Mesh> meshes;
  for (const Deforming& mesh : deforming_)
    meshes.push_back({mesh.mesh, mesh.vertices, mesh.bounds});
  structure_->update({worlds_, elsewhere, meshes});
}

}  // namespace heliograph::render
