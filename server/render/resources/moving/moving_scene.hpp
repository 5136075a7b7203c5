#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "render/api/section.hpp"
#include "render/resources/moving/moving_parts.hpp"
#include "render/resources/scene_resources.hpp"
#include "scene/animation/explosion.hpp"
#include "tracing/ray_tracer.hpp"

namespace heliograph::render {

/// A scene as one renderer sees it: the shared resources in the default pose, and over them what
/// moves and what was changed. Several renderers may show one scene at different times and in
/// different light. A scene without clips or changes costs nothing here.
///
/// What a pose changes, from one advance() to the next: matrices now and one frame ago in the table
/// of instances, the vertices of meshes that deform (processor skinning, all cores), lights, the
/// power of emissive triangles, the draw list and the acceleration structure. Buffers and structure
/// keep their identity, so that plans stay valid.
class MovingScene {
 public:
  MovingScene(const gpu::Device& device, const tracing::RayTracer& tracer,
              std::shared_ptr<const SceneResources> rest);
  ~MovingScene();

  const SceneResources& resources() const { return *resources_; }
  /// Every table as it is now; see tracing::SceneTables for how to read them.
  const tracing::SceneTables& tables() const { return *tables_; }
  /// The first call after hide() makes another one.
  const tracing::AccelerationStructure& structure();
  /// Instances as the rasteriser draws them, in the order of SceneResources::draws; without those
  /// that are hidden.
  const std::vector<Draw>& draws() const;
  /// Vertices one frame ago of the meshes that deform; only where Draw::previous_vertex points.
  const gpu::Buffer& previous_vertices() const;

  /// As they are now, and as they were one frame ago; by light of the scene.
  const std::vector<shared::Light>& lights() const { return lights_; }
  const std::vector<shared::Light>& previous_lights() const { return previous_lights_; }

  /// Emissive triangles as they are now; see tables() for how to read them.
  const EmissiveBuffers& emissive() const { return emissive_.buffers(); }
  /// shared::scene_* of the scene with its changes; without what shines, as passes go by that know
  /// no emissive triangles.
  std::uint32_t features() const;
  std::uint32_t features_without_emission() const { return features_; }

  const LitEnvironment& environment() const { return *environment_; }
  /// Whether no light of the scene's own or of a chosen environment is beside the studio's.
  bool lit_by_studio_alone() const;
  const kernels::MaterialTable& host_materials() const;
  /// shared::MaterialLayer each, what Material::layer counts; read like tables().
  const gpu::Buffer& layers() const;
  /// For the rasteriser; the first call may make them. Not while a frame runs.
  const std::vector<VkDescriptorSet>& material_sets() const;

  /// Other lights than the scene's: those of the scene, of the same kinds, where no clip moves
  /// them, then any others; from the next advance() on. Never while a frame runs, nor while a plan
  /// refers to lights of another number.
  /// @return whether tables() or features() changed: plans must be rebuilt
  bool set_lights(std::span<const shared::Light> lights);
  /// Other values for the scene's materials, with the same textures, alpha, flags and `passing`,
  /// which rays and draws go by. Material::layer counts `layers`, of which the first adds nothing;
  /// none: the scene's. Never while a frame runs.
  /// @return whether tables(), layers(), emissive() or features() changed: plans must be rebuilt
  bool set_materials(std::span<const shared::Material> materials,
                     std::span<const shared::MaterialLayer> layers = {});
  /// Whether all materials are one, grey, rough and opaque but for holes, whatever they are. Never
  /// while a frame runs; plans must be rebuilt.
  void set_plain(bool plain);
  /// Another environment than the scene's own; plans must be rebuilt.
  void set_environment(std::shared_ptr<const LitEnvironment> environment);

  /// Leaves out instances for which `hidden` is true, in every respect: rays miss them, nothing
  /// draws them, and their triangles emit no light. Empty: there are none. Never while a frame
  /// runs; plans must be rebuilt.
  void hide(std::vector<bool> hidden);
  /// Planes that cut the scene open. Never while a frame runs; plans must be rebuilt where there
  /// were none before or are none now.
  void set_section(Section section) { section_ = std::move(section); }
  const Section& section() const { return section_; }
  /// Marks instances for outline_selection() in place of those before. Never while a frame runs.
  void select(std::span<const std::uint32_t> instances);
  bool has_selection() const { return has_selection_; }
  /// A bit for each instance, whether it is selected.
  const gpu::Buffer& selection() const { return selection_; }

  /// What the next advance() goes to: a clip of this scene at `seconds`, or rest when null.
  /// @return whether that differs from where the scene is going already
  bool set_pose(const scene::Clip* clip, double seconds);
  /// How far the parts of the scene are apart, scene::Explosion's amount; from the next advance()
  /// on. Never while a frame runs, nor while a plan refers to the structure of a scene that comes
  /// apart, or together.
  /// @return whether it does: plans must be rebuilt
  bool set_explosion(float amount);
  /// Whether another advance() would change anything: a new pose, or motion that has ended but is
  /// still the motion of the frame before.
  bool needs_advance() const;
  /// Goes on by one frame: what is current becomes previous, what was set becomes current. Never
  /// while a frame runs.
  /// @return whether anything differs from the frame before
  bool advance();
  /// Whether any shape is elsewhere than one frame ago.
  bool geometry_moved() const { return geometry_moved_; }
  /// Node -> world, as it is now.
  const scene::Pose& pose() const { return pose_; }

 private:
  struct ChangedMaterials {
    gpu::Buffer table;  // shared::Material each, `count` of them
    std::size_t count;
    gpu::Buffer layers;       // shared::MaterialLayer each, with room for more; empty: the scene's
    std::size_t layer_count;  // 0: the scene's
    kernels::MaterialTable host;
    std::optional<MaterialSets> sets = std::nullopt;  // once the rasteriser needs them
  };
  struct HiddenMaterials {
    std::vector<shared::Material> materials;
    std::vector<shared::MaterialLayer> layers;  // empty: the scene's
  };

  std::span<const shared::Material> materials() const { return material_tables().materials; }
  MaterialTables material_tables() const;
  bool replace_materials(MaterialTables tables);
  bool write_layers(std::span<const shared::MaterialLayer> layers);
  bool update_layer_features(const MaterialTables& tables);
  bool remake_emissive();
  std::vector<glm::mat4> shining_worlds() const;
  void list_shown_draws();
  void make_movable();
  void take_apart();
  void assemble();
  void make_structure();
  void bind_tables();
  void move_things(const scene::Pose& before);
  bool move_lights(const scene::Pose& before);

  const gpu::Device& device_;
  std::shared_ptr<const SceneResources> resources_;
  std::shared_ptr<const LitEnvironment> environment_;
  std::unique_ptr<ChangedMaterials> changed_materials_;  // null: the scene's
  std::optional<HiddenMaterials> hidden_materials_;      // by set_plain()
  EmissiveLights emissive_;
  std::vector<shared::Light> lights_at_rest_;
  std::uint32_t features_ = 0;
  gpu::Buffer own_lights_;  // empty as long as they are the scene's and rest
  bool lights_are_new_ = false;
  scene::Pose pose_;
  std::vector<shared::Light> lights_;
  std::vector<shared::Light> previous_lights_;
  bool geometry_moved_ = false;
  std::optional<MovingParts> moving_;  // absent as long as nothing can move
  const scene::Clip* clip_ = nullptr;
  double seconds_ = 0.0;
  bool pose_is_new_ = false;
  float explosion_amount_ = 0.0f;
  std::optional<scene::Explosion> explosion_;                              // while parts are apart
  std::shared_ptr<const tracing::AccelerationStructure> apart_structure_;  // likewise
  const tracing::RayTracer& tracer_;
  std::vector<bool> hidden_;  // by instance; empty: none
  std::vector<Draw> shown_draws_;
  std::shared_ptr<const tracing::AccelerationStructure> shown_structure_;  // where any are hidden
  bool structure_is_old_ = false;
  gpu::Buffer selection_;
  bool has_selection_ = false;
  Section section_;
  std::optional<tracing::SceneTables> tables_;
};

}  // namespace heliograph::render
