#include "render/resources/moving/moving_scene.hpp"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <numbers>
#include <utility>

#include "render/resources/lights/light_table.hpp"
#include "render/resources/moving/plain_material.hpp"
#include "render/resources/moving/writable_table.hpp"
#include "scene/gltf/materials/layer_table.hpp"
#include "scene/gltf/nodes/lights.hpp"

namespace heliograph::render {

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
  if (!resources_->scene->clips.empty()) make_movable();
  bind_tables();
  if (moving_) make_structure();
}

/// Gives the renderer all that may move for itself, but for the structure.
void MovingScene::make_movable() {
  moving_.emplace(device_, *resources_->scene, resources_->draws);
  own_lights_ = make_light_table(device_, lights_);
  write_lights(own_lights_, lights_, resources_->scene->bounds);
  remake_emissive();
}

MovingScene::~MovingScene() = default;

void MovingScene::bind_tables() {
  const tracing::SceneBuffers& shared = resources_->rest_tables;
  tables_.emplace(tracing::SceneTables{
      moving_ && moving_->vertex_table() ? moving_->vertex_table() : shared.vertices,
      shared.indices, shared.meshes, moving_ ? moving_->instance_table() : shared.instances,
      changed_materials_ ? changed_materials_->table : shared.materials,
      own_lights_ ? own_lights_ : shared.lights, shared.alpha_heap});
}

MaterialTables MovingScene::material_tables() const {
  const scene::Scene& scene = *resources_->scene;
  if (!changed_materials_) return {scene.materials, scene.layers};
  const auto& [table, count, layers, layer_count, host, sets] = *changed_materials_;
  MaterialTables made{{reinterpret_cast<const shared::Material*>(table.mapped()), count},
                      scene.layers};
  if (layer_count > 0) {
    made.layers = {reinterpret_cast<const shared::MaterialLayer*>(layers.mapped()), layer_count};
  }
  return made;
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
  std::ranges::copy_if(moving_ ? moving_->draws() : resources_->draws,
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

const gpu::Buffer& MovingScene::layers() const {
  const bool own = changed_materials_ && changed_materials_->layers;
  return own ? changed_materials_->layers : resources_->layers;
}

const std::vector<VkDescriptorSet>& MovingScene::material_sets() const {
  if (!changed_materials_) return resources_->material_sets().sets;
  auto& sets = changed_materials_->sets;
  if (!sets) {
    const bool layered = (features_ & shared::scene_layers) != 0;
    sets = resources_->make_material_sets(material_tables(), layered, gpu::Memory::upload);
  }
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

bool MovingScene::set_materials(std::span<const shared::Material> materials,
                                std::span<const shared::MaterialLayer> layers) {
  if (!hidden_materials_) return replace_materials({materials, layers});
  hidden_materials_->materials.assign(materials.begin(), materials.end());
  hidden_materials_->layers.assign(layers.begin(), layers.end());
  return false;
}

void MovingScene::set_plain(bool plain) {
  if (hidden_materials_.has_value() == plain) return;
  if (!plain) {
    const HiddenMaterials hidden = *std::exchange(hidden_materials_, std::nullopt);
    replace_materials({hidden.materials, hidden.layers});
    return;
  }
  const auto& [shown, layers] = material_tables();
  hidden_materials_.emplace(HiddenMaterials{{shown.begin(), shown.end()}, {}});
  if (changed_materials_ && changed_materials_->layer_count > 0) {
    hidden_materials_->layers.assign(layers.begin(), layers.end());
  }
  std::vector<shared::Material> all(shown.size());
  std::ranges::transform(shown, all.begin(), plain_material);
  replace_materials({all, {}});
}

/// No `tables.layers`: the scene's.
bool MovingScene::replace_materials(MaterialTables tables) {
  const auto& [materials, layers] = tables;
  const bool emission = !same_emission(this->materials(), materials);
  const bool is_first = !changed_materials_;
  if (is_first) {
    changed_materials_ = std::make_unique<ChangedMaterials>(ChangedMaterials{
        writable_table(device_, "materials now", materials, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT),
        materials.size(),
        {},
        0,
        {}});
  } else {
    std::memcpy(changed_materials_->table.mapped(), materials.data(), materials.size_bytes());
  }
  bool rebuilds = write_layers(layers);
  const MaterialTables now = material_tables();
  rebuilds |= update_layer_features(now);
  if (device_.is_cpu()) changed_materials_->host = resources_->make_host_materials(now);
  auto& sets = changed_materials_->sets;
  if (sets && (rebuilds || !sets->write(now))) {
    sets.reset();
    rebuilds = true;
  }
  if (emission) rebuilds |= remake_emissive();
  if (is_first) bind_tables();
  return rebuilds || is_first;
}

/// @return whether another buffer has them
bool MovingScene::write_layers(std::span<const shared::MaterialLayer> layers) {
  auto& [table, count, own, own_count, host, sets] = *changed_materials_;
  own_count = layers.size();
  if (!own && layers.empty()) return false;
  if (layers.empty()) layers = resources_->scene->layers;
  if (layers.empty()) return false;  // no material has one
  const bool fits = own && layers.size_bytes() <= own.size();
  if (!fits) {
    constexpr std::size_t more = 8;
    own = gpu::Buffer(device_, "material layers now",
                      (layers.size() + more) * sizeof(shared::MaterialLayer),
                      VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Memory::upload);
  }
  std::memcpy(own.mapped(), layers.data(), layers.size_bytes());
  return !fits;
}

/// Shaders without layers know none. @return whether the features changed
bool MovingScene::update_layer_features(const MaterialTables& tables) {
  constexpr std::uint32_t of_layers = shared::scene_layers | shared::scene_diffuse_transmits;
  const std::uint32_t before = features_;
  features_ = (before & ~of_layers) | (resources_->features & of_layers);
  if (std::ranges::any_of(tables.materials, &shared::Material::layer)) {
    features_ |= shared::scene_layers;
  }
  if (scene::scatters_through(tables.layers)) features_ |= shared::scene_diffuse_transmits;
  // For good: an animation that passes zero shall not begin all histories again.
  if (scene::disperses(tables.layers)) features_ |= shared::scene_disperses;
  return features_ != before;
}

void MovingScene::set_environment(std::shared_ptr<const LitEnvironment> environment) {
  environment_ = std::move(environment);
}

const tracing::AccelerationStructure& MovingScene::structure() {
  if (structure_is_old_) make_structure();
  if (moving_) return moving_->structure();
  return shown_structure_ ? *shown_structure_ : *resources_->rest_structure;
}

void MovingScene::make_structure() {
  structure_is_old_ = false;
  const scene::Scene& scene = *resources_->scene;
  const auto& rest = apart_structure_ ? apart_structure_ : resources_->rest_structure;
  std::shared_ptr<const tracing::AccelerationStructure> shown;
  if (!hidden_.empty()) {
    shown = tracer_.build_without(hidden_, rest, scene, resources_->rest_tables);
  }
  if (moving_) {
    moving_->set_structure(tracer_.build_moving(shown ? shown : rest, scene, *tables_), scene);
  }
  shown_structure_ = std::move(shown);
}

const std::vector<Draw>& MovingScene::draws() const {
  if (!hidden_.empty()) return shown_draws_;
  return moving_ ? moving_->draws() : resources_->draws;
}

const gpu::Buffer& MovingScene::previous_vertices() const {
  const bool deforms = moving_ && moving_->previous_table();
  return deforms ? moving_->previous_table() : resources_->rest_tables.vertices;
}

bool MovingScene::set_pose(const scene::Clip* clip, double seconds) {
  if (resources_->scene->clips.empty()) return false;
  if (clip == clip_ && (!clip || seconds == seconds_)) return false;
  clip_ = clip;
  seconds_ = seconds;
  pose_is_new_ = true;
  return true;
}

bool MovingScene::set_explosion(float amount) {
  if (std::exchange(explosion_amount_, amount) == amount) return false;
  pose_is_new_ = true;
  const bool apart = amount > 0.0f;
  if (apart == explosion_.has_value()) return false;
  if (apart) {
    take_apart();
  } else {
    assemble();
  }
  bind_tables();
  list_shown_draws();
  make_structure();
  return true;
}

void MovingScene::take_apart() {
  const scene::Scene& scene = *resources_->scene;
  explosion_.emplace(scene);
  apart_structure_ = tracer_.build_apart(scene, resources_->rest_tables);
  if (!moving_) make_movable();
}

void MovingScene::assemble() {
  explosion_.reset();
  move_things(pose_);
  apart_structure_.reset();
  if (!resources_->scene->clips.empty()) return;
  moving_.reset();
  remake_emissive();
}

bool MovingScene::needs_advance() const {
  return lights_are_new_ || pose_is_new_ || (moving_ && !moving_->settled());
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
  if (std::exchange(pose_is_new_, false)) {
    if (clip_) {
      scene::evaluate(scene, *clip_, seconds_, pose_);
    } else {
      pose_ = scene::rest_pose(scene);
    }
    if (explosion_) explosion_->apply(explosion_amount_, pose_);
  }
  geometry_moved_ = moving_->move(scene, before, pose_);
  const std::vector<glm::mat4> shining = shining_worlds();
  emissive_.follow({scene, materials(), resources_->emission_means, shining}, moving_->placed());
  list_shown_draws();
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
