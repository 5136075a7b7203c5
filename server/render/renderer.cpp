#include "render/renderer.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <optional>

#include "render/debug_view.hpp"
#include "render/engine_parts.hpp"
#include "render/frame.hpp"
#include "render/scene_set.hpp"
#include "render/frame_set.hpp"
#include "render/moving_scene.hpp"
#include "render/view_constants.hpp"
#include "render/view_table.hpp"

namespace heliograph::render {
namespace {

constexpr std::string_view picture_name = "output";

scene::Scene empty_scene() {
  scene::Scene scene;
  scene.name = "empty";
  scene.material_names.emplace_back("none");
  scene.materials.emplace_back();
  for (const auto slot :
       {&shared::Material::base_color_texture, &shared::Material::metallic_roughness_texture,
        &shared::Material::normal_texture, &shared::Material::occlusion_texture,
        &shared::Material::emissive_texture}) {
    (scene.materials.back().*slot).texture = shared::no_texture;
  }
  return scene;
}

}  // namespace

struct Renderer::State {
  State(Engine::Parts& engine, std::shared_ptr<const SceneResources> empty)
      : parts(engine),
        nothing(std::move(empty)),
        constants_buffer(engine.device, "frame constants", sizeof(shared::FrameConstants),
                         VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, gpu::Memory::upload) {}

  void build_plan();
  void write_frame_set();
  void list_buffers();
  bool has_buffer(std::string_view name) const;
  Frame picture();
  const gpu::Image* find(std::string_view buffer) const;
  std::optional<FloatImage> read(std::string_view view) const;
  std::uint32_t wanted_samples() const {
    return settings.accumulation.enabled
               ? static_cast<std::uint32_t>(settings.accumulation.max_samples)
               : 1u;
  }
  void restart() {
    samples = 0;
    stale = true;
  }
  void apply_settings(const protocol::Settings& changed);

  Engine::Parts& parts;
  std::shared_ptr<const SceneResources> nothing;  // the empty scene
  gpu::Buffer constants_buffer;
  shared::FrameConstants constants{};
  bool has_previous = false;
  std::uint32_t sequence = 0;  // frames since the last cut: where random sequences stand
  std::uint32_t samples = 0;   // in the accumulated picture
  float seconds = 1.0f / 60.0f;  // since the frame before
  bool stale = true;          // something changed since the last frame

  std::shared_ptr<const SceneResources> scene;
  std::optional<MovingScene> moving;  // the scene in this renderer's pose
  scene::Camera camera;
  protocol::Settings settings;
  VkExtent2D extent{640, 360};

  std::unique_ptr<gpu::DescriptorPool> pool;
  std::optional<FrameInputs> inputs;
  std::unique_ptr<gpu::FramePlan> plan;
  FrameOutputs outputs;
  std::vector<BufferInfo> buffers;
};

void Renderer::State::build_plan() {
  plan.reset();
  inputs.emplace(FrameInputs{parts.programs, *scene, moving->tables(), *parts.tracer,
                             moving->structure(), constants, settings, samples, seconds, *moving,
                             parts.host_kernels});
  plan = std::make_unique<gpu::FramePlan>(parts.device, extent);
  write_frame_set();
  outputs = declare_frame(*plan, *inputs);
  plan->read_back(outputs.picture);
  plan->compile();
  list_buffers();
  has_previous = false;
  sequence = 0;
  restart();
}

void Renderer::State::apply_settings(const protocol::Settings& changed) {
  const auto scope = protocol::changed_scope(settings, changed);
  settings = changed;
  stale = true;
  if (includes(scope, protocol::ResetScope::structure)) build_plan();
  if (includes(scope, protocol::ResetScope::history)) has_previous = false;
  if (includes(scope, protocol::ResetScope::accumulation)) restart();
}

void Renderer::State::write_frame_set() {
  pool = std::make_unique<gpu::DescriptorPool>(parts.device, 2, 16);
  const VkDescriptorSet set = pool->allocate(parts.programs.frame_layout.handle());
  render::write_frame_set(parts, set, constants_buffer, moving->tables().lights,
                          scene->environment->view(settings.environment.separate_sun));
  plan->share_set(frame_set, set);
  const VkDescriptorSet tables = pool->allocate(parts.programs.scene_layout.handle());
  write_scene_set(parts.device, tables, moving->tables(), scene->texture_heap);
  plan->share_set(scene_set, tables);
}

void Renderer::State::list_buffers() {
  const auto list = [this](const std::string& view, const std::string& by_pass) {
    const std::string_view known = description_of(view), colors = legend(colors_of(view));
    std::string text = known.empty() ? by_pass : std::string(known);
    if (!colors.empty()) text.append(" ").append(colors);
    buffers.push_back({view, text});
  };
  buffers.clear();
  buffers.push_back({std::string(picture_name), "The finished picture."});
  for (const auto& view : plan->views()) {
    if (view.name == picture_name) continue;
    list(view.name, view.description);
    for (const std::string& aspect : aspects_of(view.name)) list(aspect, {});
  }
}

bool Renderer::State::has_buffer(std::string_view name) const {
  return std::any_of(buffers.begin(), buffers.end(),
                     [&](const BufferInfo& buffer) { return buffer.name == name; });
}

const gpu::Image* Renderer::State::find(std::string_view buffer) const {
  for (const auto& view : plan->views()) {
    if (view.name == buffer) return &plan->latest(view.image);
  }
  return nullptr;
}

std::optional<FloatImage> Renderer::State::read(std::string_view view) const {
  const std::string_view source = source_of(view);
  const gpu::Image* image = find(source.empty() ? view : source);
  if (!image) return std::nullopt;
  if (source.empty()) return read_image(*image);
  return extract(view, read_image(*image), {constants, exposure_factor(*plan, outputs.exposure)});
}

Frame Renderer::State::picture() {
  const std::string& shown = settings.view.buffer;
  if (shown != picture_name) {
    if (const auto values = read(shown)) return visualise(shown, *values);
  }
  Frame frame;
  frame.width = extent.width;
  frame.height = extent.height;
  frame.rgba = plan->read();
  return frame;
}

Renderer::Renderer(Engine& engine)
    : state_(std::make_unique<State>(
          engine.parts(), engine.upload(std::make_shared<const scene::Scene>(empty_scene()),
                                        scene::constant_environment(glm::vec3(0.0f))))) {
  set_scene(nullptr);
}
Renderer::~Renderer() = default;

void Renderer::set_scene(std::shared_ptr<const SceneResources> scene) {
  // The plan refers to the old scene: it goes first.
  state_->plan.reset();
  state_->inputs.reset();
  state_->scene = scene ? std::move(scene) : state_->nothing;
  state_->moving.emplace(state_->parts.device, *state_->parts.tracer, state_->scene);
  state_->build_plan();
}

void Renderer::set_size(std::uint32_t width, std::uint32_t height) {
  if (state_->extent.width == width && state_->extent.height == height) return;
  state_->extent = {width, height};
  state_->build_plan();
}

void Renderer::set_camera(const scene::Camera& camera) {
  if (scene::same_view(state_->camera, camera)) return;
  state_->camera = camera;
  state_->restart();
}

protocol::Result<void> Renderer::set_pose(std::string_view clip, double seconds) {
  const scene::Scene& scene = *state_->scene->scene;
  const scene::Clip* const found = scene::find_clip(scene, clip);
  if (!clip.empty() && !found) {
    return protocol::error::not_found("clip",
                                      "the scene has no clip \"" + std::string(clip) + "\"");
  }
  if (state_->moving->set_pose(found, seconds)) state_->restart();
  return {};
}

void Renderer::cut() {
  state_->has_previous = false;
  state_->sequence = 0;
  state_->restart();
}

void Renderer::set_frame_seconds(float seconds) {
  state_->seconds = std::max(seconds, 0.0f);
}

protocol::Result<void> Renderer::set_settings(const protocol::Settings& settings) {
  if (settings == state_->settings) return {};
  const protocol::Settings before = state_->settings;
  state_->apply_settings(settings);
  // Which buffers there are follows from the settings. One that went while it was shown leaves the
  // picture; one that is asked for and not there is refused.
  if (settings.view.buffer == before.view.buffer || state_->has_buffer(settings.view.buffer)) {
    return {};
  }
  state_->apply_settings(before);
  return protocol::error::invalid("view.buffer",
                                  "there is no buffer \"" + settings.view.buffer + "\"",
                                  "a name from frame.buffers");
}

bool Renderer::needs_frame() const {
  if (state_->stale || state_->samples < state_->wanted_samples()) return true;
  if (state_->moving->needs_advance()) return true;
  // Exposure that no time passes for stays where it is.
  return state_->seconds > 0.0f && !is_settled(*state_->plan, state_->outputs.exposure);
}

Frame Renderer::render() {
  State& state = *state_;
  const auto start = std::chrono::steady_clock::now();
  state.stale = false;
  const bool moves = state.moving->advance();
  const auto posed = std::chrono::steady_clock::now();
  if (!state.settings.accumulation.enabled) state.samples = 0;
  const shared::FrameConstants before = state.constants;
  state.constants = make_frame_constants(state.camera, state.settings, *state.scene, state.extent,
                                         state.sequence++, state.has_previous ? &before : nullptr);
  state.has_previous = true;
  std::memcpy(state.constants_buffer.mapped(), &state.constants, sizeof state.constants);
  state.plan->execute();
  ++state.samples;

  Frame frame = state.picture();
  frame.samples = state.samples;
  frame.converged = !needs_frame();
  if (moves) {
    const std::chrono::duration<float, std::milli> posing = posed - start;
    frame.passes.push_back({"pose", protocol::PassKind::host, posing.count()});
  }
  for (const auto& timing : state.plan->timings()) {
    if (timing.milliseconds < 0.0f) continue;
    const auto kind = timing.host ? protocol::PassKind::host : protocol::PassKind::device;
    frame.passes.push_back({timing.name, kind, timing.milliseconds});
  }
  const auto elapsed = std::chrono::steady_clock::now() - start;
  frame.milliseconds = std::chrono::duration<float, std::milli>(elapsed).count();
  return frame;
}

std::vector<PassWork> Renderer::work() const {
  std::vector<PassWork> all;
  for (const auto& pass : state_->plan->work()) {
    all.push_back({pass.name, pass.image_bytes, pass.entries});
  }
  return all;
}

const std::vector<BufferInfo>& Renderer::buffers() const {
  return state_->buffers;
}

protocol::Result<FloatImage> Renderer::capture(std::string_view buffer) {
  auto values = state_->read(buffer);
  if (values) return std::move(*values);
  return protocol::error::not_found("buffer",
                                    "there is no buffer \"" + std::string(buffer) + "\"");
}

protocol::Result<Frame> Renderer::capture_view(std::string_view buffer) {
  auto values = capture(buffer);
  if (!values) return values.error();
  Frame frame = visualise(buffer, values.value());
  frame.samples = state_->samples;
  return frame;
}

}  // namespace heliograph::render
