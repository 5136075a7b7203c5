#include "session/edits/animated_parts.hpp"

#include <algorithm>
#include <map>
#include <span>
#include <utility>

#include "render/api/renderer.hpp"
#include "scene/animation/pose.hpp"
#include "scene/animation/tracks.hpp"
#include "scene/gltf/materials/layer_table.hpp"
#include "scene/gltf/materials/texture_kinds.hpp"
#include "session/edits/light_form.hpp"
#include "session/edits/material_form.hpp"
#include "session/nodes/node_state.hpp"

namespace heliograph::session {
namespace {

using Pointed = scene::PointedProperty;

enum class PartKind { node, light, camera, material };

PartKind kind_of(Pointed property) {
  switch (property) {
    case Pointed::visible:
      return PartKind::node;
    case Pointed::light_color:
    case Pointed::light_intensity:
    case Pointed::light_range:
    case Pointed::inner_cone:
    case Pointed::outer_cone:
      return PartKind::light;
    case Pointed::vertical_fov:
    case Pointed::orthographic_height:
      return PartKind::camera;
    default:
      return PartKind::material;
  }
}

bool is_of_texture(Pointed property) {
  return property == Pointed::texture_offset || property == Pointed::texture_rotation ||
         property == Pointed::texture_scale;
}

TrackValue value_at(const scene::Track& track, const PartsMoment& moment) {
  return {track.property, scene::value_of(track, scene::moment_of(*moment.clip, moment.seconds))};
}

/// Of all tracks of this kind, in the order of the clip.
std::vector<TrackValue> values_of(PartKind kind, const PartsMoment& moment) {
  std::vector<TrackValue> values;
  if (!moment.clip) return values;
  for (const scene::Track& track : moment.clip->tracks) {
    if (kind_of(track.property) == kind) values.push_back(value_at(track, moment));
  }
  return values;
}

SceneEdits::Lights lights_of(const scene::Scene& scene) {
  SceneEdits::Lights lights;
  for (const scene::Light& light : scene.lights) lights.push_back(light.device);
  return lights;
}

/// By light of the scene: whether its node is visible; empty: all are.
std::vector<bool> shown_lights(const scene::Scene& scene, const std::vector<bool>& shown_nodes) {
  std::vector<bool> shown;
  if (shown_nodes.empty()) return shown;
  for (const scene::Light& light : scene.lights) {
    shown.push_back(!light.node || shown_nodes[*light.node]);
  }
  return std::ranges::find(shown, false) == shown.end() ? std::vector<bool>() : shown;
}

shared::Light animated_light(const PartsMoment& moment, std::size_t number,
                             std::span<const TrackValue> values) {
  const scene::Light& light = moment.scene->lights[number];
  const protocol::LightInfo initial = session::describe(light);
  const auto& edited = moment.members.lights;
  const protocol::LightInfo now = edited ? (*edited)[number] : initial;
  return device_form(animated(now, *light.punctual, values), initial, light.device);
}

SceneEdits::Lights animated_lights(const PartsMoment& moment, const std::vector<bool>& shown) {
  const scene::Scene& scene = *moment.scene;
  std::map<std::uint32_t, std::vector<TrackValue>> values;  // by number in the file
  if (moment.clip) {
    for (const scene::Track& track : moment.clip->tracks) {
      if (kind_of(track.property) != PartKind::light) continue;
      values[track.object].push_back(value_at(track, moment));
    }
  }
  SceneEdits::Lights lights = moment.edited.lights ? *moment.edited.lights : lights_of(scene);
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const auto& file = scene.lights[i].punctual;
    const auto own = file ? values.find(file->number) : values.end();
    if (own != values.end()) lights[i] = animated_light(moment, i, own->second);
    if (!shown.empty() && !shown[i]) lights[i].color = glm::vec3(0.0f);
  }
  return lights;
}

/// A material and what its tracks make of it.
struct AnimatedMaterial {
  std::vector<TrackValue> values;
  bool layered = false;  // whether they concern its layer
  FileMaterial file;     // with the texture transforms of this moment
};

/// By number; and the texture transforms that tracks change, by AnimatedSlot.
struct CollectedMaterials {
  const scene::Scene& scene;
  std::map<std::uint32_t, AnimatedMaterial> materials = {};
  std::map<std::uint32_t, scene::TextureTransform> transforms = {};

  AnimatedMaterial& material(std::uint32_t number) {
    const auto [found, is_new] = materials.try_emplace(number);
    if (is_new) found->second.file = file_material(scene, number);
    return found->second;
  }
  void add(const scene::Track& track, const TrackValue& value) {
    if (is_of_texture(track.property)) {
      const scene::TextureTransform& file = scene.animated_slots[track.object].transform;
      animate(transforms.try_emplace(track.object, file).first->second, value);
      return;
    }
    AnimatedMaterial& animated = material(track.object);
    animated.values.push_back(value);
    animated.layered |= is_of_layer(track.property);
  }
  void apply_transforms() {
    for (const auto& [number, transform] : transforms) {
      const scene::AnimatedSlot& slot = scene.animated_slots[number];
      const scene::TextureKind& kind = scene::texture_kinds()[slot.kind];
      AnimatedMaterial& animated = material(slot.material);
      transform.apply(kind.of(animated.file.device, animated.file.extensions));
      animated.layered |= kind.of_extension();
    }
  }
};

/// The clip has tracks of materials.
std::map<std::uint32_t, AnimatedMaterial> collect_materials(const PartsMoment& moment) {
  CollectedMaterials collected{*moment.scene};
  for (const scene::Track& track : moment.clip->tracks) {
    if (kind_of(track.property) != PartKind::material) continue;
    collected.add(track, value_at(track, moment));
  }
  collected.apply_transforms();
  return std::move(collected.materials);
}

/// The edited ones, or those of the scene.
struct MaterialLists {
  SceneEdits::Materials materials;
  SceneEdits::Layers layers;
};

void animate_material(const PartsMoment& moment, std::uint32_t number,
                      const AnimatedMaterial& material, MaterialLists& lists) {
  const auto& edited = moment.members.materials;
  const protocol::MaterialInfo now = animated(edited ? (*edited)[number] : describe(material.file),
                                              material.file.extensions, material.values);
  shared::Material& device = lists.materials[number];
  const std::uint32_t layer = device.layer;
  device = device_form(now, material.file.device);
  device.layer = layer;
  if (!material.layered) return;
  // Also where it adds nothing at this moment: whether the scene has layers decides about shaders.
  device.layer = static_cast<std::uint32_t>(lists.layers.size());
  lists.layers.push_back(layer_form(now, material.file));
}

MaterialLists animated_materials(const PartsMoment& moment) {
  const SceneParts& edited = moment.edited;
  MaterialLists lists{edited.materials ? *edited.materials : moment.scene->materials,
                      edited.layers ? *edited.layers : moment.scene->layers};
  if (lists.layers.empty()) lists.layers.push_back(scene::plain_layer());
  for (const auto& [number, material] : collect_materials(moment)) {
    animate_material(moment, number, material, lists);
  }
  return lists;
}

}  // namespace

SceneParts AnimatedParts::at(const PartsMoment& moment) {
  if (!moment.scene || !scene::has_tracks(*moment.scene)) {
    *this = {};
    return moment.edited;
  }
  const std::vector<bool> shown = scene::shown_nodes(*moment.scene, moment.clip, moment.seconds);
  update_lights(moment, shown);
  update_materials(moment);
  update_hidden(moment, shown);
  return parts_;
}

void AnimatedParts::update_lights(const PartsMoment& moment, const std::vector<bool>& shown) {
  Origin origin{moment.scene, moment.clip, moment.edited.lights, values_of(PartKind::light, moment),
                shown_lights(*moment.scene, shown)};
  if (origin == of_lights_) return;
  const bool differ = !origin.values.empty() || !origin.shown.empty();
  parts_.lights =
      differ ? std::make_shared<const SceneEdits::Lights>(animated_lights(moment, origin.shown))
             : moment.edited.lights;
  of_lights_ = std::move(origin);
}

void AnimatedParts::update_materials(const PartsMoment& moment) {
  Origin origin{moment.scene,
                moment.clip,
                moment.edited.materials,
                values_of(PartKind::material, moment),
                {}};
  if (origin == of_materials_) return;
  parts_.materials = moment.edited.materials;
  parts_.layers = moment.edited.layers;
  if (!origin.values.empty()) {
    auto [materials, layers] = animated_materials(moment);
    parts_.materials = std::make_shared<const SceneEdits::Materials>(std::move(materials));
    parts_.layers = std::make_shared<const SceneEdits::Layers>(std::move(layers));
  }
  of_materials_ = std::move(origin);
}

void AnimatedParts::update_hidden(const PartsMoment& moment, const std::vector<bool>& shown) {
  Origin origin{moment.scene, nullptr, moment.edited.hidden, {}, shown};
  if (origin == of_hidden_) return;
  const auto before = std::exchange(parts_.hidden, moment.edited.hidden);
  if (!shown.empty()) {
    const std::vector<std::uint32_t> nodes = nodes_of_instances(*moment.scene);
    std::vector<bool> hidden =
        moment.edited.hidden ? *moment.edited.hidden : std::vector<bool>(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) hidden[i] = hidden[i] || !shown[nodes[i]];
    const bool any = std::ranges::find(hidden, true) != hidden.end();
    const bool same = before && *before == hidden;
    if (any) parts_.hidden = same ? before : std::make_shared<const std::vector<bool>>(hidden);
  }
  of_hidden_ = std::move(origin);
}

bool ShownParts::show(render::Renderer& renderer, const PartsMoment& moment) {
  const SceneParts parts = animated_.at(moment);
  const SceneParts before = std::exchange(shown_, parts);
  const SceneParts edited_before = std::exchange(edited_, moment.edited);
  const auto why = [](bool same_edits) {
    return same_edits ? render::PartChange::animation : render::PartChange::edit;
  };
  if (parts.lights != before.lights) {
    renderer.set_lights(parts.lights ? *parts.lights : lights_of(*moment.scene),
                        why(moment.edited.lights == edited_before.lights));
  }
  if (parts.materials != before.materials) {
    renderer.set_materials(
        parts.materials ? *parts.materials : moment.scene->materials,
        parts.layers ? std::span(*parts.layers) : std::span<const shared::MaterialLayer>(),
        why(moment.edited.materials == edited_before.materials));
  }
  if (parts.hidden == before.hidden) return false;
  renderer.set_hidden(parts.hidden ? *parts.hidden : std::vector<bool>());
  return true;
}

void ShownParts::reset() {
  *this = {};
}

}  // namespace heliograph::session
