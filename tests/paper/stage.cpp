#include "tests/paper/stage.hpp"

#include <stdexcept>

#include "scene/animation/pose.hpp"
#include "scenes/generator/scenes/paper_scenes.hpp"
#include "tests/support/generated_scene.hpp"

namespace heliograph::paper {
namespace {

constexpr int sky_width = 512;
constexpr int sky_height = 256;

/// The scene's first camera at `seconds` of its clip.
scene::Camera camera_at(const scene::Scene& scene, double seconds) {
  scene::Camera camera = scene.cameras.at(0);
  const scene::Clip* clip = scene::find_clip(scene, name(Movement::moving_camera));
  if (!clip || !camera.node) throw std::runtime_error("the scene has no camera animation");
  scene::Pose pose = scene::rest_pose(scene);
  scene::evaluate(scene, *clip, seconds, pose);
  const glm::mat4& world = pose.worlds.at(*camera.node);
  const float distance = glm::distance(camera.eye, camera.target);
  camera.eye = glm::vec3(world[3]);
  camera.target = camera.eye - distance * glm::normalize(glm::vec3(world[2]));
  camera.up = glm::normalize(glm::vec3(world[1]));
  return camera;
}

}  // namespace

Stage::Stage(render::Engine& engine, const std::string& scene, const scenes::Sweep& sweep,
             const StageOptions& options)
    : engine_(engine), options_(options) {
  const scenes::PaperScene& recipe = scenes::find_paper_scene(scene);
  const scenes::ClearSky sky = recipe.make_sky(sky_width, sky_height);
  scenes::Document document = recipe.make_document(sky);
  scenes::apply(sweep, document);
  scene_ =
      std::make_shared<const scene::Scene>(test::import_generated(document, options.texture_size));
  resources_ = engine.upload(scene_, test::import_generated(sky.environment));
}

std::unique_ptr<render::Renderer> Stage::start(const protocol::Settings& settings,
                                               const Shot& shot) const {
  auto renderer = std::make_unique<render::Renderer>(engine_);
  renderer->set_scene(resources_);
  renderer->set_size(options_.width, options_.height);
  renderer->set_camera(scene_->cameras.at(0));
  renderer->set_frame_seconds(shot.frame_seconds);
  const auto accepted = renderer->set_settings(settings);
  if (!accepted) throw std::runtime_error(accepted.error().message);
  return renderer;
}

void Stage::show_moment(render::Renderer& renderer, const Shot& shot, int frame) const {
  const double seconds = static_cast<double>(frame) * static_cast<double>(shot.frame_seconds);
  if (shot.movement == Movement::moving_camera) renderer.set_camera(camera_at(*scene_, seconds));
  if (shot.movement != Movement::moving_objects_light) return;
  const auto posed = renderer.set_pose(name(shot.movement), seconds);
  if (!posed) throw std::runtime_error(posed.error().message);
}

Played Stage::play(const protocol::Settings& settings, const Shot& shot) const {
  const auto renderer = start(settings, shot);
  renderer->set_draw_scale(options_.draw_scale);
  const double pixels = double(options_.width) * double(options_.height);
  Played played;
  for (int i = 0; i < shot.frames; ++i) {
    show_moment(*renderer, shot, i);
    render::Frame frame = renderer->render();
    if (i < shot.frames - shot.compared) continue;
    played.frames.push_back(std::move(frame));
    for (const render::PassWork& pass : renderer->work()) {
      if (pass.name.starts_with("gbuffer") || !pass.name.ends_with(".trace")) continue;
      played.rays_per_pixel += double(pass.rays) / (pixels * shot.compared);
    }
  }
  return played;
}

std::vector<render::Frame> Stage::time(const protocol::Settings& settings, const Shot& shot) const {
  const auto renderer = start(settings, shot);
  renderer->set_draw_scale(options_.draw_scale);
  std::vector<render::Frame> frames;
  for (int i = 0; i < shot.frames; ++i) {
    show_moment(*renderer, shot, i);
    frames.push_back(renderer->render());
    frames.back().rgba.clear();
  }
  return frames;
}

std::vector<render::Frame> Stage::rest(const protocol::Settings& settings, const Shot& shot,
                                       int samples) const {
  const auto renderer = start(settings, shot);
  for (int i = 0; i + 1 < shot.frames; ++i) {
    show_moment(*renderer, shot, i);
    renderer->render();
  }
  show_moment(*renderer, shot, shot.frames - 1);
  std::vector<render::Frame> frames;
  for (int i = 0; i < samples; ++i) frames.push_back(renderer->render());
  return frames;
}

std::vector<render::Frame> Stage::ground_truth(GroundTruth source, const Shot& shot,
                                               int samples) const {
  protocol::Settings settings;
  settings.accumulation.max_samples = samples;
  settings.accumulation.blend_samples = 0;
  settings.antialiasing.temporal = false;
  if (source != GroundTruth::accumulated) {
    settings.reference.use = protocol::ReferenceUse::always;
    settings.reference.scope = source == GroundTruth::full ? protocol::ReferenceScope::full
                                                           : protocol::ReferenceScope::same_paths;
  } else {
    settings.indirect.enabled = false;
    settings.shadow_temporal.enabled = settings.specular_temporal.enabled = false;
    settings.shadow_blur.enabled = settings.specular_blur.enabled = false;
  }
  const auto renderer = start(settings, shot);
  std::vector<render::Frame> frames;
  for (int i = shot.frames - shot.compared; i < shot.frames; ++i) {
    show_moment(*renderer, shot, i);
    render::Frame frame = renderer->render();
    while (!frame.converged) frame = renderer->render();
    frames.push_back(std::move(frame));
    if (shot.movement == Movement::still) break;
  }
  frames.resize(static_cast<std::size_t>(shot.compared), frames.front());
  return frames;
}

}  // namespace heliograph::paper
