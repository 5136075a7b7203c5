#include "render/renderer.hpp"

#include <chrono>
#include <cstring>
#include <optional>

#include "render/debug_view.hpp"
#include "render/engine_parts.hpp"
#include "render/frame.hpp"
#include "render/view_constants.hpp"

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
  Frame picture();
  const gpu::Image* find(std::string_view buffer) const;
  std::uint32_t wanted_samples() const {
    return settings.accumulation.enabled
               ? static_cast<std::uint32_t>(settings.accumulation.max_samples)
               : 1u;
  }
  void restart() {
    samples = 0;
    stale = true;
  }

  Engine::Parts& parts;
  std::shared_ptr<const SceneResources> nothing;  // the empty scene
  gpu::Buffer constants_buffer;
  shared::FrameConstants constants{};
  bool has_previous = false;
  std::uint32_t samples = 0;  // in the accumulated picture
  bool stale = true;          // something changed since the last frame

  std::shared_ptr<const SceneResources> scene;
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
  inputs.emplace(FrameInputs{parts.programs, *scene, *parts.tracer, constants, samples});
  plan = std::make_unique<gpu::FramePlan>(parts.device, extent);
  write_frame_set();
  outputs = declare_frame(*plan, *inputs);
  plan->compile();
  has_previous = false;
  restart();
}

void Renderer::State::write_frame_set() {
  pool = std::make_unique<gpu::DescriptorPool>(parts.device, 1, 8);
  const VkDescriptorSet set = pool->allocate(parts.programs.frame_layout.handle());
  constexpr auto uniform = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
  gpu::DescriptorWriter(parts.device, set)
      .buffer(0, uniform, constants_buffer.handle())
      .buffer(1, uniform, scene->light_block.handle())
      .sampled_image(2, scene->environment.map.view(), parts.around.handle())
      .sampled_image(3, scene->environment.prefiltered.view(), parts.clamped.handle())
      .sampled_image(4, parts.split_sum_table.view(), parts.clamped.handle())
      .apply();
  plan->share_set(frame_set, set);
}

void Renderer::State::list_buffers() {
  buffers.clear();
  buffers.push_back({std::string(picture_name), "The finished picture."});
  for (const auto& view : plan->views()) {
    if (view.name != picture_name) buffers.push_back({view.name, view.description});
  }
}

const gpu::Image* Renderer::State::find(std::string_view buffer) const {
  for (const auto& view : plan->views()) {
    if (view.name == buffer) return &plan->latest(view.image);
  }
  return nullptr;
}

Frame Renderer::State::picture() {
  const gpu::Image* image = find(settings.view.buffer);
  if (image && settings.view.buffer != picture_name) {
    return visualise(settings.view.buffer, read_image(*image));
  }
  Frame frame;
  frame.width = extent.width;
  frame.height = extent.height;
  const std::vector<std::byte> bytes = plan->latest(outputs.picture).download();
  frame.rgba.resize(bytes.size());
  std::memcpy(frame.rgba.data(), bytes.data(), bytes.size());
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
  state_->build_plan();
  state_->list_buffers();
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

protocol::Result<void> Renderer::set_settings(const protocol::Settings& settings) {
  bool known = false;
  for (const BufferInfo& buffer : state_->buffers) known |= buffer.name == settings.view.buffer;
  if (!known) {
    return protocol::error::invalid("view.buffer",
                                    "there is no buffer \"" + settings.view.buffer + "\"",
                                    "a name from frame.buffers");
  }
  if (settings == state_->settings) return {};
  const auto scope = protocol::changed_scope(state_->settings, settings);
  state_->settings = settings;
  state_->stale = true;
  if (includes(scope, protocol::ResetScope::accumulation)) state_->restart();
  return {};
}

bool Renderer::needs_frame() const {
  return state_->stale || state_->samples < state_->wanted_samples();
}

Frame Renderer::render() {
  State& state = *state_;
  const auto start = std::chrono::steady_clock::now();
  state.stale = false;
  if (!state.settings.accumulation.enabled) state.samples = 0;
  const shared::FrameConstants before = state.constants;
  state.constants = make_frame_constants(state.camera, state.settings, *state.scene, state.extent,
                                         state.samples, state.has_previous ? &before : nullptr);
  state.has_previous = true;
  std::memcpy(state.constants_buffer.mapped(), &state.constants, sizeof state.constants);
  state.plan->execute();
  ++state.samples;

  Frame frame = state.picture();
  frame.samples = state.samples;
  frame.converged = !needs_frame();
  for (const auto& timing : state.plan->timings()) {
    if (timing.milliseconds < 0.0f) continue;
    const auto kind = timing.host ? protocol::PassKind::host : protocol::PassKind::device;
    frame.passes.push_back({timing.name, kind, timing.milliseconds});
  }
  const auto elapsed = std::chrono::steady_clock::now() - start;
  frame.milliseconds = std::chrono::duration<float, std::milli>(elapsed).count();
  return frame;
}

const std::vector<BufferInfo>& Renderer::buffers() const {
  return state_->buffers;
}

protocol::Result<FloatImage> Renderer::capture(std::string_view buffer) {
  const gpu::Image* image = state_->find(buffer);
  if (!image) {
    return protocol::error::not_found("buffer",
                                      "there is no buffer \"" + std::string(buffer) + "\"");
  }
  return read_image(*image);
}

protocol::Result<Frame> Renderer::capture_view(std::string_view buffer) {
  auto values = capture(buffer);
  if (!values) return values.error();
  Frame frame = visualise(buffer, values.value());
  frame.samples = state_->samples;
  return frame;
}

}  // namespace heliograph::render
