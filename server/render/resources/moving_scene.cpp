#include "render/resources/moving_scene.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <numbers>
#include <utility>

#include "render/resources/lights/light_table.hpp"
#include "render/resources/placement.hpp"
#include "render/resources/plain_material.hpp"
#include "scene/animation/deform.hpp"
#include "scene/gltf/nodes/lights.hpp"

namespace heliograph::render {
namespace {

template <typename Element>
gpu::Buffer writable_table(const gpu::Device& device, const char* name,
                           std::span<const Element> elements, VkBufferUsageFlags usage) {
  gpu::Buffer table(device, name, elements.size_bytes(), usage, gpu::Memory::upload);
  std::memcpy(table.mapped(), elements.data(), elements.size_bytes());
  return table;
}

std::vector<shared::Vertex> all_vertices(const scene::Scene& scene) {
  std::vector<shared::Vertex> vertices;
  for (const scene::Mesh& mesh : scene.meshes) {
    vertices.insert(vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
  }
  return vertices;
}

}  // namespace

/// What a scene with clips has for each renderer.
struct MovingScene::Moving {
  /// A mesh that deforms, on the processor.
  struct Deforming {
    std::vector<shared::Vertex> vertices;  // now
    scene::Bounds bounds;
    std::uint32_t mesh = 0;
    std::size_t first_vertex = 0;     // in the table of all vertices
    std::size_t previous_vertex = 0;  // in the table of vertices one frame ago
    bool moved = false;               // by the last advance
    bool moved_before = false;        // by the one before that
  };

  Moving(const gpu::Device& device, const SceneResources& rest);

  /// Each brings one kind of thing to `pose`; true when anything is now, or was a frame ago,
  /// elsewhere.
  bool move_instances(const scene::Scene& scene, const scene::Pose& pose);
  bool deform(const scene::Scene& scene, const scene::Pose& before, const scene::Pose& pose);
  void move_draws(const scene::Scene& scene);
  void update_structure();
  /// Brings a structure in the default pose to the present one.
  void pose_structure(const scene::Scene& scene);

  std::vector<shared::Instance> instances;
  std::vector<Draw> draws;
  std::vector<std::uint32_t> draw_of;  // by instance
  std::vector<Deforming> deforming;    // by deformation of the scene
  std::vector<std::uint32_t> moved;    // instances that the last advance moved or brought to rest
  std::vector<std::uint32_t> placed;   // those of them with a new matrix
  std::vector<glm::mat4> worlds;       // by instance
  std::vector<scene::Bounds> bounds;   // by mesh

  gpu::Buffer instance_table;
  gpu::Buffer vertex_table;  // empty when no mesh deforms
  gpu::Buffer previous_table;
  std::unique_ptr<tracing::MovingStructure> structure;

  const scene::Clip* clip = nullptr;
  double seconds = 0.0;
  bool pose_is_new = false;
  bool settled = true;  // nothing moved in the last advance
};

MovingScene::Moving::Moving(const gpu::Device& device, const SceneResources& rest)
    : draws(rest.draws), draw_of(rest.scene->instances.size()) {
  const scene::Scene& scene = *rest.scene;
  for (const scene::Instance& instance : scene.instances) {
    worlds.push_back(scene.nodes[instance.node].world);
    instances.push_back(place_mesh(instance.mesh, worlds.back()));
  }
  for (const scene::Mesh& mesh : scene.meshes) bounds.push_back(mesh.bounds);
  for (std::uint32_t i = 0; i < draws.size(); ++i) draw_of[draws[i].constants.instance] = i;
  instance_table =
      writable_table(device, "instances now", std::span<const shared::Instance>(instances),
                     VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  if (scene.deformations.empty()) return;

  std::vector<std::size_t> first_vertex;
  std::size_t count = 0;
  for (const scene::Mesh& mesh : scene.meshes) {
    first_vertex.push_back(count);
    count += mesh.vertices.size();
  }
  std::vector<shared::Vertex> previous;
  for (const scene::Deformation& deformation : scene.deformations) {
    const scene::Mesh& mesh = scene.meshes[deformation.mesh];
    deforming.push_back({mesh.vertices, mesh.bounds, deformation.mesh,
                         first_vertex[deformation.mesh], previous.size()});
    previous.insert(previous.end(), mesh.vertices.begin(), mesh.vertices.end());
  }
  const std::vector<shared::Vertex> all = all_vertices(scene);
  vertex_table =
      writable_table(device, "vertices now", std::span(all),
                     VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
  previous_table =
      writable_table(device, "vertices before", std::span<const shared::Vertex>(previous),
                     VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
  for (const Deforming& mesh : deforming) {
    for (shared::Instance& instance : instances) {
      if (instance.mesh != mesh.mesh) continue;
      instance.previous_vertex = static_cast<std::uint32_t>(mesh.previous_vertex) + 1;
    }
  }
  std::memcpy(instance_table.mapped(), instances.data(), std::span(instances).size_bytes());
}

bool MovingScene::Moving::move_instances(const scene::Scene& scene, const scene::Pose& pose) {
  moved.clear();
  placed.clear();
  auto* const table = reinterpret_cast<shared::Instance*>(instance_table.mapped());
  for (std::uint32_t i = 0; i < instances.size(); ++i) {
    shared::Instance& instance = instances[i];
    const glm::mat4& world = pose.worlds[scene.instances[i].node];
    const bool moves = world != instance.world;
    if (!moves && instance.previous_world == instance.world) continue;
    move_instance(instance, world);
    table[i] = instance;
    moved.push_back(i);
    if (!moves) continue;
    placed.push_back(i);
    worlds[i] = world;
  }
  return !moved.empty();
}

bool MovingScene::Moving::deform(const scene::Scene& scene, const scene::Pose& before,
                                 const scene::Pose& pose) {
  auto* const table = reinterpret_cast<shared::Vertex*>(vertex_table.mapped());
  auto* const previous = reinterpret_cast<shared::Vertex*>(previous_table.mapped());
  tbb::parallel_for(std::size_t(0), deforming.size(), [&](std::size_t i) {
    const scene::Deformation& deformation = scene.deformations[i];
    Deforming& mesh = deforming[i];
    mesh.moved_before = mesh.moved;
    mesh.moved = scene::shape_differs(scene, deformation, before, pose);
    if (mesh.moved || mesh.moved_before) {
      std::ranges::copy(mesh.vertices, previous + mesh.previous_vertex);
    }
    if (!mesh.moved) return;
    mesh.bounds = scene::deform(scene, deformation, pose, mesh.vertices);
    bounds[deformation.mesh] = mesh.bounds;
    std::ranges::copy(mesh.vertices, table + mesh.first_vertex);
  });
  return std::ranges::any_of(deforming,
                             [](const Deforming& mesh) { return mesh.moved || mesh.moved_before; });
}

void MovingScene::Moving::move_draws(const scene::Scene& scene) {
  const auto move = [&](std::uint32_t instance) {
    Draw& draw = draws[draw_of[instance]];
    draw.constants = draw_constants(instances[instance], instance);
    draw.flipped = instances[instance].flags & shared::instance_flipped;
    draw.bounds = world_bounds(bounds[scene.instances[instance].mesh], worlds[instance]);
  };
  for (const std::uint32_t instance : moved) move(instance);
  if (deforming.empty()) return;
  for (std::uint32_t i = 0; i < instances.size(); ++i) {
    if (draws[draw_of[i]].previous_vertex) move(i);
  }
}

void MovingScene::Moving::update_structure() {
  std::vector<tracing::Movement::Mesh> meshes;
  for (const Deforming& mesh : deforming) {
    if (mesh.moved) meshes.push_back({mesh.mesh, mesh.vertices, mesh.bounds});
  }
  structure->update({worlds, placed, meshes});
}

void MovingScene::Moving::pose_structure(const scene::Scene& scene) {
  std::vector<std::uint32_t> elsewhere;
  for (std::uint32_t i = 0; i < worlds.size(); ++i) {
    if (worlds[i] != scene.nodes[scene.instances[i].node].world) elsewhere.push_back(i);
  }
  std::vector<tracing::Movement::Mesh> meshes;
  for (const Deforming& mesh : deforming) meshes.push_back({mesh.mesh, mesh.vertices, mesh.bounds});
  structure->update({worlds, elsewhere, meshes});
}

MovingScene::MovingScene(const gpu::Device& device, const tracing::RayTracer& tracer,
                         std::shared_ptr<const SceneResources> rest)
    : device_(device),
      resources_(std::move(rest)),
      environment_(resources_->environment),
      emissive_(device, resources_->emissive),
      pose_(scene::rest_pose(*resources_->scene)),
      tracer_(tracer),
      selection_(device, "selected instances",
                 (resources_->scene->instances.size() / 32 + 1) * sizeof(std::uint32_t),
                 VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Memory::upload) {
  select({});
  for (const scene::Light& light : resources_->scene->lights)
    lights_at_rest_.push_back(light.device);
  lights_ = lights_at_rest_;
  previous_lights_ = lights_;
  features_ = resources_->features & ~shared::scene_emissive;
  if (!resources_->scene->clips.empty()) {
    moving_ = std::make_unique<Moving>(device, *resources_);
    own_lights_ = make_light_table(device, lights_);
    write_lights(own_lights_, lights_, resources_->scene->bounds);
    remake_emissive();
  }
  bind_tables();
  if (!moving_) return;
  moving_->structure =
      tracer.build_moving(resources_->rest_structure, *resources_->scene, *tables_);
}

MovingScene::~MovingScene() = default;

void MovingScene::bind_tables() {
  const tracing::SceneBuffers& shared = resources_->rest_tables;
  tables_.emplace(tracing::SceneTables{
      moving_ && moving_->vertex_table ? moving_->vertex_table : shared.vertices, shared.indices,
      shared.meshes, moving_ ? moving_->instance_table : shared.instances,
      changed_materials_ ? changed_materials_->table : shared.materials,
      own_lights_ ? own_lights_ : shared.lights, shared.alpha_heap});
}

std::span<const shared::Material> MovingScene::materials() const {
  if (!changed_materials_) return resources_->scene->materials;
  const auto& [table, count, host, sets] = *changed_materials_;
  return {reinterpret_cast<const shared::Material*>(table.mapped()), count};
}

bool MovingScene::remake_emissive() {
  const scene::Scene& scene = *resources_->scene;
  const std::size_t capacity = emissive_capacity(scene, materials());
  if (capacity == 0 && !emissive_.may_shine()) return false;
  const std::vector<glm::mat4> worlds = shining_worlds();
  return emissive_.remake({scene, materials(), resources_->emission_means, worlds}, capacity);
}

/// Of every instance; those of hidden ones have no size, so that nothing of them shines.
std::vector<glm::mat4> MovingScene::shining_worlds() const {
  const scene::Scene& scene = *resources_->scene;
  std::vector<glm::mat4> worlds;
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const bool hidden = !hidden_.empty() && hidden_[i];
    worlds.push_back(hidden ? glm::mat4(0.0f) : pose_.worlds[scene.instances[i].node]);
  }
  return worlds;
}

void MovingScene::hide(std::vector<bool> hidden) {
  hidden_ = std::move(hidden);
  structure_is_old_ = true;
  list_shown_draws();
  remake_emissive();
}

void MovingScene::list_shown_draws() {
  shown_draws_.clear();
  if (hidden_.empty()) return;
  std::ranges::copy_if(moving_ ? moving_->draws : resources_->draws,
                       std::back_inserter(shown_draws_),
                       [&](const Draw& draw) { return !hidden_[draw.constants.instance]; });
}

void MovingScene::select(std::span<const std::uint32_t> instances) {
  auto* const words = reinterpret_cast<std::uint32_t*>(selection_.mapped());
  std::memset(words, 0, selection_.size());
  for (const std::uint32_t i : instances) words[i / 32] |= 1u << (i % 32);
  has_selection_ = !instances.empty();
}

std::uint32_t MovingScene::features() const {
  return features_ | (emissive_.may_shine() ? shared::scene_emissive : 0u);
}

bool MovingScene::lit_by_studio_alone() const {
  if (!environment_->source()->is_studio || !lights_.empty()) return false;
  // Displays and indicators light nothing else: what shines counts from a fiftieth of what radiance
  // 1 sends through a sphere around the scene.
  constexpr float pi = std::numbers::pi_v<float>, least_share = 0.02f;
  const float radius = resources_->scene->bounds.radius();
  return resources_->emissive_power < least_share * pi * 4.0f * pi * radius * radius;
}

const kernels::MaterialTable& MovingScene::host_materials() const {
  return changed_materials_ ? changed_materials_->host : resources_->host_materials;
}

const std::vector<VkDescriptorSet>& MovingScene::material_sets() const {
  if (!changed_materials_) return resources_->material_sets().sets;
  auto& sets = changed_materials_->sets;
  if (!sets) sets = resources_->make_material_sets(materials(), gpu::Memory::upload);
  return sets->sets;
}

bool MovingScene::set_lights(std::span<const shared::Light> lights) {
  constexpr std::uint32_t of_lights =
      shared::scene_area_lights | shared::scene_many_lights | shared::scene_light_grid;
  lights_at_rest_.assign(lights.begin(), lights.end());
  lights_are_new_ = true;
  const bool others = lights.size() != lights_.size();
  if (own_lights_ && !others) return false;
  if (others) {
    lights_ = lights_at_rest_;
    previous_lights_ = lights_;
    features_ = (features_ & ~of_lights) | light_features(lights_);
  }
  own_lights_ = make_light_table(device_, lights_);
  write_lights(own_lights_, lights_, resources_->scene->bounds);
  bind_tables();
  return true;
}

bool MovingScene::set_materials(std::span<const shared::Material> materials) {
  if (!hidden_materials_) return replace_materials(materials);
  hidden_materials_->assign(materials.begin(), materials.end());
  return false;
}

void MovingScene::set_plain(bool plain) {
  if (hidden_materials_.has_value() == plain) return;
  if (!plain) {
    replace_materials(*std::exchange(hidden_materials_, std::nullopt));
    return;
  }
  const std::span<const shared::Material> shown = materials();
  hidden_materials_.emplace(shown.begin(), shown.end());
  std::vector<shared::Material> all(shown.size());
  std::ranges::transform(shown, all.begin(), plain_material);
  replace_materials(all);
}

bool MovingScene::replace_materials(std::span<const shared::Material> materials) {
  const bool emission = !same_emission(this->materials(), materials);
  kernels::MaterialTable host;
  if (device_.is_cpu()) host = resources_->make_host_materials(materials);
  if (changed_materials_) {
    std::memcpy(changed_materials_->table.mapped(), materials.data(), materials.size_bytes());
    if (changed_materials_->sets) changed_materials_->sets->write(materials);
    changed_materials_->host = std::move(host);
    return emission && remake_emissive();
  }
  changed_materials_ = std::make_unique<ChangedMaterials>(ChangedMaterials{
      writable_table(device_, "materials now", materials, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT),
      materials.size(), std::move(host)});
  if (emission) remake_emissive();
  bind_tables();
  return true;
}

void MovingScene::set_environment(std::shared_ptr<const LitEnvironment> environment) {
  environment_ = std::move(environment);
}

const tracing::AccelerationStructure& MovingScene::structure() {
  if (std::exchange(structure_is_old_, false)) make_structure();
  if (moving_) return *moving_->structure;
  return shown_structure_ ? *shown_structure_ : *resources_->rest_structure;
}

void MovingScene::make_structure() {
  const scene::Scene& scene = *resources_->scene;
  const auto& rest = resources_->rest_structure;
  std::shared_ptr<const tracing::AccelerationStructure> shown;
  if (!hidden_.empty()) {
    shown = tracer_.build_without(hidden_, rest, scene, resources_->rest_tables);
  }
  if (moving_) {
    moving_->structure = tracer_.build_moving(shown ? shown : rest, scene, *tables_);
    moving_->pose_structure(scene);
  }
  shown_structure_ = std::move(shown);
}

const std::vector<Draw>& MovingScene::draws() const {
  if (!hidden_.empty()) return shown_draws_;
  return moving_ ? moving_->draws : resources_->draws;
}

const gpu::Buffer& MovingScene::previous_vertices() const {
  const bool deforms = moving_ && moving_->previous_table;
  return deforms ? moving_->previous_table : resources_->rest_tables.vertices;
}

bool MovingScene::set_pose(const scene::Clip* clip, double seconds) {
  if (!moving_ || (clip == moving_->clip && (!clip || seconds == moving_->seconds))) return false;
  moving_->clip = clip;
  moving_->seconds = seconds;
  moving_->pose_is_new = true;
  return true;
}

bool MovingScene::needs_advance() const {
  return lights_are_new_ || (moving_ && (moving_->pose_is_new || !moving_->settled));
}

bool MovingScene::advance() {
  previous_lights_ = lights_;
  geometry_moved_ = false;
  if (!needs_advance()) return false;
  const scene::Pose before = pose_;
  if (moving_) move_things(before);
  const bool lights = move_lights(before);
  return geometry_moved_ || lights;
}

void MovingScene::move_things(const scene::Pose& before) {
  const scene::Scene& scene = *resources_->scene;
  if (moving_->pose_is_new) {
    if (moving_->clip) {
      scene::evaluate(scene, *moving_->clip, moving_->seconds, pose_);
    } else {
      pose_ = scene::rest_pose(scene);
    }
  }
  moving_->pose_is_new = false;
  const bool instances = moving_->move_instances(scene, pose_);
  const bool shapes = moving_->deform(scene, before, pose_);
  const std::vector<glm::mat4> shining = shining_worlds();
  emissive_.follow({scene, materials(), resources_->emission_means, shining}, moving_->placed);
  moving_->move_draws(scene);
  list_shown_draws();
  moving_->update_structure();
  moving_->settled = moving_->placed.empty() &&
                     std::ranges::none_of(moving_->deforming, &Moving::Deforming::moved);
  geometry_moved_ = instances || shapes;
}

bool MovingScene::move_lights(const scene::Pose& before) {
  const scene::Scene& scene = *resources_->scene;
  bool any = lights_are_new_;
  for (std::size_t i = 0; i < lights_.size(); ++i) {
    const auto node = i < scene.lights.size() ? scene.lights[i].node : std::nullopt;
    const bool moves = node && before.worlds[*node] != pose_.worlds[*node];
    if (!moves && !lights_are_new_) continue;
    const bool carried = node && pose_.worlds[*node] != scene.nodes[*node].world;
    const shared::Light& rest = lights_at_rest_[i];
    lights_[i] = carried || moves ? scene::place_light(rest, pose_.worlds[*node]) : rest;
    any = true;
  }
  lights_are_new_ = false;
  if (any) write_lights(own_lights_, lights_, scene.bounds);
  return any;
}

}  // namespace heliograph::render
