#include "render/api/renderer.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

#include "render/api/buffer_names.hpp"
#include "render/frame/buffer_list.hpp"
#include "render/frame/probe.hpp"
#include "render/frame/renderer_state.hpp"
#include "render/passes/post/mean_weight.hpp"
#include "render/passes/shading/draw_shading.hpp"
#include "render/views/debug_view.hpp"
#include "render/views/text_overlay.hpp"

namespace heliograph::render {
namespace {

/// Whether lights differ in position and direction alone.
bool only_move(std::span<const shared::Light> before, std::span<const shared::Light> after) {
  return std::ranges::equal(before, after, [](const shared::Light& a, const shared::Light& b) {
    return a.color == b.color && a.radius == b.radius && a.range == b.range &&
           a.half_width == b.half_width && a.half_height == b.half_height &&
           a.spot_scale == b.spot_scale && a.spot_offset == b.spot_offset;
  });
}

}  // namespace

std::uint32_t drawn_side(std::uint32_t side, float scale) {
  return std::max(1u, static_cast<std::uint32_t>(std::lround(scale * static_cast<float>(side))));
}

Renderer::Renderer(Engine& engine, std::shared_ptr<const SceneResources> scene)
    : state_(std::make_unique<State>(engine.parts(), engine.empty_scene())) {
  set_scene(std::move(scene));
}
Renderer::~Renderer() = default;

void Renderer::set_scene(std::shared_ptr<const SceneResources> scene) {
  // The plan refers to the old scene: it is freed first.
  state_->free_frame_plan();
  state_->scene = scene ? std::move(scene) : state_->nothing;
  state_->moving.emplace(state_->parts.device, *state_->parts.tracer, state_->scene);
  state_->moving->set_plain(is_plain(state_->settings));
  state_->moving->set_explosion(state_->settings.view.explode);
  state_->discard_frame_plan();
}

void Renderer::set_lights(std::span<const shared::Light> lights, PartChange change) {
  const bool moves = change == PartChange::animation || only_move(state_->moving->lights(), lights);
  // The plan refers to the table of lights, which another number of them replaces.
  if (lights.size() != state_->moving->lights().size()) state_->free_frame_plan();
  if (state_->moving->set_lights(lights)) {
    state_->discard_frame_plan();
  } else {
    if (!moves) state_->has_previous = false;
    state_->restart_accumulation();
  }
}

void Renderer::set_materials(std::span<const shared::Material> materials,
                             std::span<const shared::MaterialLayer> layers, PartChange change) {
  if (state_->moving->set_materials(materials, layers)) {
    state_->discard_frame_plan();
  } else {
    if (change == PartChange::edit) state_->has_previous = false;
    state_->restart_accumulation();
  }
}

void Renderer::set_environment(std::shared_ptr<const LitEnvironment> environment) {
  state_->free_frame_plan();
  state_->moving->set_environment(environment ? std::move(environment)
                                              : state_->scene->environment);
  state_->discard_frame_plan();
}

void Renderer::set_hidden(std::vector<bool> hidden) {
  state_->free_frame_plan();  // refers to the structure
  state_->moving->hide(std::move(hidden));
  state_->discard_frame_plan();
}

void Renderer::set_section(Section section) {
  if (state_->moving->section() == section) return;
  (void)section_constants(section);
  const bool declares = state_->moving->section().planes.empty() != section.planes.empty();
  state_->moving->set_section(std::move(section));
  if (declares) {
    state_->discard_frame_plan();
  } else {
    state_->has_previous = false;
    state_->restart_accumulation();
  }
}

void Renderer::set_selected(std::span<const std::uint32_t> instances) {
  state_->moving->select(instances);
  state_->stale = true;
}

void Renderer::set_size(std::uint32_t width, std::uint32_t height) {
  if (state_->extent.width == width && state_->extent.height == height) return;
  state_->extent = {width, height};
  state_->discard_frame_plan();
}

void Renderer::set_draw_scale(float scale) {
  scale = std::clamp(scale, 0.0f, 1.0f);
  if (std::exchange(state_->draw_scale, scale) != scale) state_->set_drawn();
}

void Renderer::set_camera(const scene::Camera& camera) {
  if (scene::same_view(state_->camera, camera)) return;
  state_->camera = camera;
  state_->restart_accumulation();
}

protocol::Result<void> Renderer::set_pose(std::string_view clip, double seconds) {
  const scene::Scene& scene = *state_->scene->scene;
  const scene::Clip* const known = scene::find_clip(scene, clip);
  if (!clip.empty() && !known) {
    return protocol::error::not_found("clip",
                                      "the scene has no clip \"" + std::string(clip) + "\"");
  }
  if (state_->moving->set_pose(known, seconds)) state_->restart_accumulation();
  return {};
}

void Renderer::invalidate_history() {
  state_->has_previous = false;
  state_->sample_index = 0;
  state_->restart_accumulation();
}

void Renderer::reset() {
  state_->discard_frame_plan();
}

void Renderer::set_frame_seconds(float seconds) {
  state_->clock.seconds = std::max(seconds, 0.0f);
}

protocol::Result<void> Renderer::set_settings(const protocol::Settings& settings) {
  if (const auto known = check_buffer_name(settings.view.buffer, "view.buffer"); !known) {
    return known;
  }
  protocol::Settings chosen = settings;
  choose_reference(chosen);
  choose_shading(chosen);
  if (chosen != state_->settings) state_->change_settings(chosen);
  return {};
}

void Renderer::keep_buffers(bool keep) {
  state_->keeps_buffers = keep;
}

bool Renderer::has_buffers() const {
  return state_->has_buffers;
}

void Renderer::request_jpeg(std::optional<JpegRequest> request) {
  state_->requested_jpeg = request;
}

std::vector<std::uint8_t> Renderer::read_pixels() {
  const auto& compiled = state_->compiled;
  return compiled && compiled->has_frame ? compiled->plan.read() : std::vector<std::uint8_t>();
}

bool Renderer::can_prepare() const {
  return !state_->compiled && !state_->parts.device.is_cpu() && !state_->parts.shader_reload;
}

void Renderer::prepare() {
  state_->frame_plan();
}

bool Renderer::has_discarded() const {
  return state_->discarded != nullptr;
}

void Renderer::free_discarded() {
  state_->discarded.reset();
}

bool Renderer::has_begun() const {
  return state_->compiled && !state_->new_plan;
}

bool Renderer::needs_frame() const {
  if (state_->keeps_buffers && !state_->has_buffers) return true;
  const auto& reload = state_->parts.shader_reload;
  if (reload && reload->version() != state_->shader_version) return true;
  if (state_->stale || state_->clock.samples < state_->target_samples()) return true;
  if (!state_->compiled || state_->moving->needs_advance()) return true;
  // Without time between frames exposure does not change.
  const CompiledFrame& compiled = *state_->compiled;
  return state_->clock.seconds > 0.0f && !is_settled(compiled.plan, compiled.outputs.exposure);
}

Frame Renderer::render() {
  return *render({});
}

std::optional<Frame> Renderer::render(const std::function<bool()>& canceled) {
  if (!begin(canceled)) return std::nullopt;
  return finish();
}

bool Renderer::begin(const std::function<bool()>& canceled) {
  State& state = *state_;
  State::Begun begun{.start = std::chrono::steady_clock::now()};
  state.use_newest_shaders();
  CompiledFrame& compiled = state.frame_plan();
  begun.new_buffers = std::exchange(state.new_plan, false);
  begun.jpeg = state.jpeg = state.next_jpeg();
  compiled.has_frame = false;
  state.stale = false;
  state.has_buffers = false;
  state.all_buffers = state.buffers_needed();
  compiled.plan.keep_images(state.all_buffers);
  if (state.pose()) {
    const auto posed = std::chrono::steady_clock::now();
    const std::chrono::duration<float, std::milli> posing = posed - begun.start;
    begun.posing = posing.count();
  }
  if (!state.settings.accumulation.enabled) state.clock.samples = 0;
  if (state.reference_takes_over()) state.clock.hybrid_samples = state.clock.samples;
  const shared::FrameConstants before = state.constants;
  const bool had_previous = state.has_previous;
  const std::uint32_t age = std::exchange(state.clock.age, had_previous ? state.clock.age + 1 : 0);
  state.make_constants(before);
  if (compiled.plan.begin(canceled)) {
    compiled.uniform_weight = uniform_mean_weight(compiled.inputs);
    begun.only_shown = is_only_shown(compiled.inputs);
    state.begun.push_back(begun);
    state.count_sample();
    return true;
  }
  state.constants = before;
  state.has_previous = had_previous;
  state.clock.age = age;
  --state.sample_index;
  state.stale = true;
  return false;
}

bool Renderer::in_flight() const {
  return state_->compiled && state_->compiled->plan.in_flight();
}

bool Renderer::can_begin_another() const {
  return state_->can_begin_another();
}

float Renderer::part_before_next() const {
  return state_->compiled ? state_->compiled->plan.part_before_next() : 1.0f;
}

bool Renderer::wait_for(std::chrono::nanoseconds time) const {
  return !state_->compiled || state_->compiled->plan.wait_for(time);
}

Frame Renderer::finish() {
  State& state = *state_;
  CompiledFrame& compiled = *state.compiled;
  compiled.plan.finish();
  const State::Begun begun = state.begun.front();
  state.begun.pop_front();
  const bool newest = state.begun.empty();
  compiled.has_frame = newest;
  state.has_buffers = newest && compiled.plan.keeps_images() && !begun.only_shown;

  Frame frame = state.output(begun.jpeg);
  if (state.parts.shader_reload) {
    draw_text(state.parts.shader_reload->error(), frame.rgba, frame.width, frame.height);
  }
  frame.samples = begun.samples;
  if (compiled.outputs.radiance_cache) {
    frame.radiance_cache = radiance_cache_use(compiled.plan, *compiled.outputs.radiance_cache);
  }
  frame.converged = newest && !needs_frame();
  frame.new_buffers = begun.new_buffers;
  state.list_passes(begun, frame);
  const auto elapsed = std::chrono::steady_clock::now() - begun.start;
  frame.milliseconds = std::chrono::duration<float, std::milli>(elapsed).count();
  return frame;
}

std::vector<PassWork> Renderer::work() const {
  std::vector<PassWork> all;
  for (const auto& pass : state_->frame_plan().plan.work()) {
    const auto known = std::ranges::find(all, pass.name, &PassWork::name);
    if (known == all.end()) {
      all.push_back({pass.name, pass.image_bytes, pass.entries});
    } else {
      known->rays += pass.entries;  // in the same images
    }
  }
  return all;
}

const std::vector<BufferInfo>& Renderer::buffers() const {
  return state_->frame_plan().buffers;
}

protocol::Result<FloatImage> Renderer::capture(std::string_view buffer) {
  auto values = state_->read(buffer);
  if (values) return std::move(*values);
  return protocol::error::not_found(
      "buffer", "there is no buffer \"" + std::string(buffer) + "\" with these settings");
}

protocol::Result<Frame> Renderer::capture_view(std::string_view buffer) {
  auto values = capture(buffer);
  if (!values) return values.error();
  Frame frame = visualise(buffer, values.value());
  frame.samples = state_->clock.samples;
  return frame;
}

std::vector<BufferValue> Renderer::inspect(glm::vec2 point) const {
  const CompiledFrame& compiled = state_->frame_plan();
  return inspect_buffers(
      compiled, {state_->constants, exposure_factor(compiled.plan, compiled.outputs.exposure)},
      point);
}

protocol::Result<std::optional<SurfacePoint>> Renderer::pick(glm::vec2 point) const {
  return surface_at(state_->frame_plan(), state_->constants, point);
}

}  // namespace heliograph::render
