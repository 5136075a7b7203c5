#include "session/session_scene.hpp"

#include <nlohmann/json.hpp>
#include <utility>

#include "session/edits/edited_parts.hpp"
#include "session/edits/texture_edits.hpp"
#include "session/library/scene_description.hpp"

namespace heliograph::session {

using protocol::Result;

namespace {

/// Node numbers and what is edited mean something in that file only.
bool from_same_file(const scene::Scene& one, const scene::Scene& other) {
  if (one.sources.empty() || other.sources.empty()) return one.sources == other.sources;
  return one.sources.front() == other.sources.front();
}

}  // namespace

Result<protocol::SceneInfo> SessionScene::info() const {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> loaded = core_.require_scene(); !loaded) return loaded.error();
  return core_.scene_info;
}

void SessionScene::show(LoadedScene scene, const std::string& by) {
  (void)show(std::move(scene), {}, by);  // a document without entries fits every scene
}

Result<void> SessionScene::show(LoadedScene scene, const protocol::EditDocument& edits,
                                const std::string& by) {
  std::unique_lock lock(core_.mutex);
  if (const auto fits = adopt(scene.scene, edits, by); !fits) return fits;
  core_.scene = scene.scene;
  core_.scene_info = describe_scene(scene);
  core_.resources = std::move(scene.resources);
  ++core_.scene_loads;
  core_.timeline.reset_clock();
  std::optional<std::uint32_t> seen_since;
  if (core_.first_view) {
    core_.camera = std::move(core_.first_view->camera);
    seen_since = core_.first_view->scene_rev;
    core_.first_view.reset();
  } else {
    core_.camera.reset(*core_.scene, core_.aspect());
  }
  core_.changed();
  core_.scene_rev = seen_since.value_or(core_.rev);
  core_.notify_others<protocol::notifications::scene_changed>(
      by, {.scene = core_.scene_info, .by = by});
  lock.unlock();
  core_.lead_cameras(by);
  return {};
}

Result<void> SessionScene::show_variant(LoadedScene scene,
                                        const std::optional<protocol::EditDocument>& edits,
                                        const std::string& by) {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> loaded = core_.require_scene(); !loaded) return loaded;
  if (!from_same_file(*scene.scene, *core_.scene)) {
    return protocol::error::conflict(
        "scene", "the file of " + scene.name + " has changed since it was loaded: load it again");
  }
  const std::vector<std::uint32_t> selected = core_.nodes.selected();
  protocol::EditDocument document = edits ? *edits : described_edits();
  if (!edits) document.environment.reset();
  if (const auto fits = adopt(scene.scene, document, by); !fits) return fits;
  core_.nodes.select(selected);
  core_.scene = scene.scene;
  core_.scene_info = describe_scene(scene);
  core_.resources = std::move(scene.resources);
  if (edits) {
    edits_changed(by);
    return {};
  }
  core_.changed();
  core_.notify_others_latest<protocol::notifications::textures_changed>(
      by, {.rev = core_.rev, .by = by});
  return {};
}

void SessionScene::show_first_view(std::shared_ptr<const scene::Scene> scene,
                                   std::shared_ptr<const render::SceneResources> resources,
                                   const std::string& by) {
  const std::lock_guard lock(core_.mutex);
  FirstView view{std::move(scene), std::move(resources), core_.shown_camera()};
  view.camera.reset(*view.scene, core_.aspect());
  core_.first_view = std::move(view);
  core_.changed();
  core_.first_view->scene_rev = core_.rev;
  core_.tell_camera(by);
}

void SessionScene::end_first_view() {
  std::unique_lock lock(core_.mutex);
  if (!core_.first_view) return;
  core_.camera.take_inputs(core_.first_view->camera);
  core_.first_view.reset();
  core_.changed();
  if (!core_.scene) return;
  core_.tell_camera({});
  // To those that have begun to follow it meanwhile.
  core_.pass_camera_on(std::move(lock), {});
}

void SessionScene::unload(const std::string& by) {
  const std::lock_guard lock(core_.mutex);
  if (!core_.scene) return;
  ++core_.scene_loads;
  const protocol::SceneUnloaded message{.name = core_.scene_info.name, .by = by};
  core_.scene = nullptr;
  core_.scene_info = {};
  core_.edits = {};
  core_.nodes = {};
  core_.section = {};
  core_.resources = nullptr;
  core_.environment = nullptr;
  core_.environment_name.reset();
  core_.timeline.reset_clock();
  core_.camera.clear_name();
  core_.changed();
  core_.scene_rev = core_.rev;
  core_.notify_others<protocol::notifications::scene_unloaded>(by, message);
}

Result<protocol::LightList> SessionScene::lights() const {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> loaded = core_.require_scene(); !loaded) return loaded.error();
  return protocol::LightList{.lights = core_.edits.lights(), .rev = core_.rev};
}

Result<protocol::LightState> SessionScene::patch_light(const protocol::LightsPatch& request,
                                                       const std::string& by) {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> loaded = core_.require_scene(); !loaded) return loaded.error();
  const auto before = core_.edits.device_lights();
  Result<protocol::LightInfo> light = core_.edits.patch(request);
  if (!light) return light.error();
  if (core_.edits.device_lights() != before) {
    core_.changed();
    core_.notify_others<protocol::notifications::lights_changed>(
        by, {.light = *light, .rev = core_.rev, .by = by});
  }
  return protocol::LightState{.light = *std::move(light), .rev = core_.rev};
}

Result<protocol::LightState> SessionScene::add_light(const protocol::LightAdd& request,
                                                     const std::string& by) {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> loaded = core_.require_scene(); !loaded) return loaded.error();
  Result<protocol::LightInfo> light = core_.edits.add(request);
  if (!light) return light.error();
  edits_changed(by);
  return protocol::LightState{.light = *std::move(light), .rev = core_.rev};
}

Result<protocol::LightList> SessionScene::remove_light(const protocol::LightName& request,
                                                       const std::string& by) {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> loaded = core_.require_scene(); !loaded) return loaded.error();
  if (const auto removed = core_.edits.remove_light(request.light); !removed) {
    return removed.error();
  }
  edits_changed(by);
  return protocol::LightList{.lights = core_.edits.lights(), .rev = core_.rev};
}

protocol::SectionState SessionScene::section_state() const {
  const protocol::Section& section = core_.section.get();
  return {.planes = section.planes, .cap_color = section.cap_color, .rev = core_.rev};
}

Result<protocol::SectionState> SessionScene::section() const {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> loaded = core_.require_scene(); !loaded) return loaded.error();
  return section_state();
}

Result<protocol::SectionState> SessionScene::set_section(const protocol::Section& section,
                                                         const std::string& by) {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> loaded = core_.require_scene(); !loaded) return loaded.error();
  const protocol::Section before = core_.section.get();
  if (const Result<void> set = core_.section.set(section); !set) return set.error();
  if (core_.section.get() != before) {
    core_.changed();
    const protocol::Section& now = core_.section.get();
    core_.notify_others_latest<protocol::notifications::section_changed>(
        by, {.planes = now.planes, .cap_color = now.cap_color, .rev = core_.rev, .by = by});
  }
  return section_state();
}

Result<protocol::EditsState> SessionScene::edits() const {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> loaded = core_.require_scene(); !loaded) return loaded.error();
  return protocol::EditsState{
      .scene = core_.scene_info.name, .edits = described_edits(), .rev = core_.rev};
}

protocol::EditDocument SessionScene::described_edits() const {
  protocol::EditDocument document;
  core_.edits.describe(document);
  describe_textures(*core_.scene, document);
  document.hidden = core_.nodes.hidden();
  document.isolated = core_.nodes.isolated();
  if (core_.section.get() != protocol::Section()) document.section = core_.section.get();
  document.environment =
      protocol::EnvironmentEdit{.name = core_.environment_name,
                                .rotation = core_.settings.environment.rotation,
                                .intensity = core_.settings.environment.intensity};
  return document;
}

Result<protocol::TextureList> SessionScene::textures() const {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> loaded = core_.require_scene(); !loaded) return loaded.error();
  protocol::TextureList list = list_textures(*core_.scene);
  list.rev = core_.rev;
  return list;
}

Result<protocol::TextureState> SessionScene::texture(const std::string& material,
                                                     const std::string& slot) const {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> loaded = core_.require_scene(); !loaded) return loaded.error();
  return protocol::TextureState{.texture = describe_texture(*core_.scene, material, slot),
                                .rev = core_.rev};
}

Result<SessionScene::Shown> SessionScene::shown() const {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> loaded = core_.require_scene(); !loaded) return loaded.error();
  return Shown{core_.scene_info.name, core_.scene};
}

Result<SceneExport> SessionScene::exported() const {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> loaded = core_.require_scene(); !loaded) return loaded.error();
  const auto& environment = core_.settings.environment;
  const bool other =
      core_.environment_name || environment.rotation != 0.0f || environment.intensity != 1.0f;
  return make_export(core_.scene, core_.edits, core_.nodes, core_.section, other);
}

Result<void> SessionScene::apply_edits(const protocol::EditDocument& document,
                                       const std::string& by) {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> loaded = core_.require_scene(); !loaded) return loaded;
  const std::vector<std::uint32_t> selected = core_.nodes.selected();
  if (const Result<void> fits = adopt(core_.scene, document, by); !fits) return fits;
  core_.nodes.select(selected);
  edits_changed(by);
  return {};
}

Result<void> SessionScene::adopt(const std::shared_ptr<const scene::Scene>& scene,
                                 const protocol::EditDocument& document, const std::string& by) {
  SceneEdits edits(scene);
  if (const auto fits = edits.apply(document); !fits) return fits;
  NodeState nodes(scene);
  if (const auto fits = apply_visibility(document, nodes); !fits) return fits;
  SectionPlanes section;
  if (document.section) {
    if (const auto fits = section.set(*document.section, "edits.section."); !fits) return fits;
  }
  if (const auto& environment = document.environment) {
    const protocol::RawJson values(nlohmann::json{
        {"environment",
         {{"rotation", environment->rotation}, {"intensity", environment->intensity}}}});
    const auto set = core_.patch_settings(values, by);
    if (!set) return set.error();
    if (!environment->name) {
      core_.environment = nullptr;
      core_.environment_name.reset();
    }
  }
  core_.edits = std::move(edits);
  core_.nodes = std::move(nodes);
  core_.section = std::move(section);
  return {};
}

void SessionScene::edits_changed(const std::string& by) {
  core_.changed();
  core_.notify_others_latest<protocol::notifications::edits_changed>(by,
                                                                     {.rev = core_.rev, .by = by});
}

Result<protocol::MaterialList> SessionScene::materials() const {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> loaded = core_.require_scene(); !loaded) return loaded.error();
  return protocol::MaterialList{.materials = core_.edits.materials(), .rev = core_.rev};
}

Result<protocol::MaterialState> SessionScene::patch_material(
    const protocol::MaterialsPatch& request, const std::string& by) {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> loaded = core_.require_scene(); !loaded) return loaded.error();
  const auto before = core_.edits.device_materials();
  Result<protocol::MaterialInfo> material = core_.edits.patch(request);
  if (!material) return material.error();
  if (core_.edits.device_materials() != before) {
    core_.changed();
    core_.notify_others<protocol::notifications::materials_changed>(
        by, {.material = *material, .rev = core_.rev, .by = by});
  }
  return protocol::MaterialState{.material = *std::move(material), .rev = core_.rev};
}

protocol::EnvironmentState SessionScene::environment() const {
  const std::lock_guard lock(core_.mutex);
  return {.environments = {},
          .current = core_.environment_name,
          .rotation = core_.settings.environment.rotation,
          .intensity = core_.settings.environment.intensity,
          .rev = core_.rev};
}

Result<void> SessionScene::set_environment(
    std::optional<std::string> name, std::shared_ptr<const render::LitEnvironment> environment,
    const std::string& by) {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> loaded = core_.require_scene(); !loaded) return loaded;
  if (name == core_.environment_name && environment == core_.environment) return {};
  core_.environment = std::move(environment);
  core_.environment_name = std::move(name);
  core_.changed();
  core_.notify_others_latest<protocol::notifications::environment_changed>(
      by, {.current = core_.environment_name, .rev = core_.rev, .by = by});
  return {};
}

}  // namespace heliograph::session
