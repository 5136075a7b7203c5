#include "render/api/renderer.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

#include "render/api/buffer_names.hpp"
#include "render/frame/buffer_list.hpp"
#include "render/frame/compiled_frame.hpp"
#include "render/frame/frame_constants.hpp"
#include "render/frame/probe.hpp"
#include "render/passes/post/present.hpp"
#include "render/passes/sampling/plan_samples.hpp"
#include "render/resources/moving_scene.hpp"
#include "render/resources/scene_motion.hpp"
#include "render/views/debug_view.hpp"
#include "render/views/text_overlay.hpp"
#include "render/views/view_colors.hpp"

namespace heliograph::render {
namespace {

/// `automatic` as one of the others. On processors a path traced sample takes several times as long
/// as one of the hybrid, whose mean is as similar to the truth as that of a hundred of them.
void choose_reference(protocol::Settings& settings, bool on_processor) {
  protocol::Settings::Reference& reference = settings.reference;
  if (reference.use != protocol::ReferenceUse::automatic) return;
  const bool traces = !on_processor && settings.indirect.enabled;
  reference.use = traces ? protocol::ReferenceUse::when_static : protocol::ReferenceUse::off;
  if (traces) reference.scope = protocol::ReferenceScope::full;
}

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

struct Renderer::State {
  State(Engine::Parts& engine, std::shared_ptr<const SceneResources> empty)
      : parts(engine), nothing(std::move(empty)), constants_buffers(engine.device) {
    choose_reference(settings, parts.device.is_cpu());
  }

  void discard_frame_plan();
  CompiledFrame& frame_plan();
  VkExtent2D drawn() const;
  void set_drawn();
  void change_settings(const protocol::Settings& changed);
  void use_newest_shaders();
  Frame output();
  /// Whether all buffers of the next frame are kept: a view of one of them needs them, too.
  bool buffers_needed() const {
    const std::string& shown = settings.view.buffer;
    return keeps_buffers ||
           (shown != present_buffers.output.name && shown != present_buffers.radiance.name);
  }
  std::optional<FloatImage> read(std::string_view name);
  std::uint32_t target_samples() const;
  bool reference_takes_over() const;
  void restart_accumulation() {
    clock.samples = 0;
    clock.hybrid_samples.reset();
    clock.carried_share = 1.0f;
    stale = true;
  }

  Engine::Parts& parts;
  std::shared_ptr<const SceneResources> nothing;  // the empty scene
  FrameConstantsBuffers constants_buffers;
  shared::FrameConstants constants{};
  shared::FrameConstants half_constants{};  // at_half_size()
  bool has_previous = false;
  std::uint32_t sample_index = 0;  // frames since the history was invalidated
  FrameClock clock;
  SceneMotion scene_motion;
  bool keeps_buffers = true;          // as requested
  bool has_buffers = false;           // of the last frame
  bool stale = true;                  // something changed since the last frame
  std::uint64_t shader_version = 0;   // of ShaderReload::version, as of the last frame
  std::uint64_t program_version = 0;  // of ShaderReload::program_version, likewise

  std::shared_ptr<const SceneResources> scene;
  std::optional<MovingScene> moving;  // the scene in this renderer's pose
  scene::Camera camera;
  protocol::Settings settings;
  VkExtent2D extent{640, 360};  // of the finished frame
  float draw_scale = 1.0f;

  std::unique_ptr<CompiledFrame> compiled;  // absent until it is needed: see frame_plan()
};

std::uint32_t Renderer::State::target_samples() const {
  if (!settings.accumulation.enabled) return 1;
  const auto most = static_cast<std::uint32_t>(settings.accumulation.max_samples);
  if (settings.reference.use != protocol::ReferenceUse::when_static) return most;
  return clock.hybrid_samples.value_or(most) +
         static_cast<std::uint32_t>(settings.reference.samples);
}

/// In the next frame, and in those that follow until the view changes.
bool Renderer::State::reference_takes_over() const {
  return settings.reference.use == protocol::ReferenceUse::when_static &&
         settings.accumulation.enabled && !clock.hybrid_samples && clock.samples > 0 &&
         clock.samples >= static_cast<std::uint32_t>(settings.accumulation.max_samples);
}

/// Changes of size, scene and settings that follow each other cost one plan together.
void Renderer::State::discard_frame_plan() {
  compiled.reset();
  has_buffers = false;
  has_previous = false;
  sample_index = 0;
  restart_accumulation();
}

CompiledFrame& Renderer::State::frame_plan() {
  if (compiled) return *compiled;
  const FrameInputs inputs{parts.programs,
                           *scene,
                           moving->tables(),
                           *parts.tracer,
                           moving->structure(),
                           constants,
                           half_constants,
                           settings,
                           clock,
                           *moving,
                           scene_motion,
                           parts.split_sum_table,
                           parts.sheen_table,
                           parts.ltc_table,
                           extent};
  compiled =
      std::make_unique<CompiledFrame>(parts, inputs, constants_buffers, extent, buffers_needed());
  compiled->plan.set_drawn(drawn());
  return *compiled;
}

VkExtent2D Renderer::State::drawn() const {
  if (settings.reference.use == protocol::ReferenceUse::always) return extent;
  return {drawn_side(extent.width, draw_scale), drawn_side(extent.height, draw_scale)};
}

void Renderer::State::set_drawn() {
  const auto pixels = [](VkExtent2D size) { return float(size.width) * float(size.height); };
  restart_accumulation();
  if (!compiled) return;
  const float before = pixels(compiled->plan.drawn());
  compiled->plan.set_drawn(drawn());
  clock.carried_share = std::min(before / pixels(drawn()), 1.0f);
}

void Renderer::State::change_settings(const protocol::Settings& changed) {
  const auto scope = protocol::changed_scope(settings, changed);
  settings = changed;
  if (includes(scope, protocol::ResetScope::structure)) discard_frame_plan();
  stale = true;
  if (includes(scope, protocol::ResetScope::history)) has_previous = false;
  if (includes(scope, protocol::ResetScope::accumulation)) restart_accumulation();
}

/// Other programs make other frames: histories of the old ones are invalid.
void Renderer::State::use_newest_shaders() {
  if (!parts.shader_reload) return;
  shader_version = parts.shader_reload->version();
  parts.shader_reload->apply();
  const std::uint64_t programs = parts.shader_reload->program_version();
  if (std::exchange(program_version, programs) == programs) return;
  has_previous = false;
  restart_accumulation();
}

std::optional<FloatImage> Renderer::State::read(std::string_view name) {
  frame_plan();
  if (name == present_buffers.radiance.name) return shown_radiance(*compiled);
  const View view = find_view(name);
  const auto image = view ? compiled->find(view.buffer->name) : std::nullopt;
  if (!image) return std::nullopt;
  return extract(view, read_image(image->whole, image->drawn),
                 {constants, exposure_factor(compiled->plan, compiled->outputs.exposure)});
}

Frame Renderer::State::output() {
  const std::string& shown = settings.view.buffer;
  if (shown != present_buffers.output.name) {
    if (const auto values = read(shown)) return visualise(shown, *values);
  }
  Frame frame;
  frame.width = extent.width;
  frame.height = extent.height;
  frame.rgba = compiled->plan.read();
  return frame;
}

Renderer::Renderer(Engine& engine)
    : state_(std::make_unique<State>(engine.parts(), engine.empty_scene())) {
  set_scene(nullptr);
}
Renderer::~Renderer() = default;

void Renderer::set_scene(std::shared_ptr<const SceneResources> scene) {
  // The plan refers to the old scene: it is freed first.
  state_->compiled.reset();
  state_->scene = scene ? std::move(scene) : state_->nothing;
  state_->moving.emplace(state_->parts.device, *state_->parts.tracer, state_->scene);
  state_->discard_frame_plan();
}

void Renderer::set_lights(std::span<const shared::Light> lights) {
  const bool moves = only_move(state_->moving->lights(), lights);
  if (state_->moving->set_lights(lights)) {
    state_->discard_frame_plan();
  } else {
    if (!moves) state_->has_previous = false;
    state_->restart_accumulation();
  }
}

void Renderer::set_materials(std::span<const shared::Material> materials) {
  if (state_->moving->set_materials(materials)) {
    state_->discard_frame_plan();
  } else {
    state_->has_previous = false;
    state_->restart_accumulation();
  }
}

void Renderer::set_environment(std::shared_ptr<const LitEnvironment> environment) {
  state_->compiled.reset();
  state_->moving->set_environment(environment ? std::move(environment)
                                              : state_->scene->environment);
  state_->discard_frame_plan();
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
  choose_reference(chosen, state_->parts.device.is_cpu());
  if (chosen != state_->settings) state_->change_settings(chosen);
  return {};
}

void Renderer::keep_buffers(bool keep) {
  state_->keeps_buffers = keep;
}

bool Renderer::has_buffers() const {
  return state_->has_buffers;
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
  State& state = *state_;
  const auto start = std::chrono::steady_clock::now();
  state.use_newest_shaders();
  const bool is_new = !state.compiled;
  CompiledFrame& compiled = state.frame_plan();
  state.stale = false;
  state.has_buffers = false;
  if (!is_new) compiled.plan.keep_images(state.buffers_needed());
  bool moves = state.moving->advance();
  // Without a frame before there is no motion since.
  if (!state.has_previous) moves |= state.moving->advance();
  const auto posed = std::chrono::steady_clock::now();
  if (!state.settings.accumulation.enabled) state.clock.samples = 0;
  if (state.reference_takes_over()) state.clock.hybrid_samples = state.clock.samples;
  const shared::FrameConstants before = state.constants;
  const bool had_previous = state.has_previous;
  const std::uint32_t age = std::exchange(state.clock.age, had_previous ? state.clock.age + 1 : 0);
  state.constants = make_frame_constants(
      state.camera, state.settings, *state.moving, {.drawn = state.drawn(), .shown = state.extent},
      state.sample_index++, state.has_previous ? &before : nullptr);
  const SceneMotion motion_before = state.scene_motion;
  state.scene_motion =
      render::scene_motion(*state.moving, state.constants, state.has_previous ? &before : nullptr);
  const auto count = [&](bool changes, std::uint32_t still) {
    if (changes) return 0u;
    return state.has_previous && still < ~0u ? still + 1 : ~0u;
  };
  state.scene_motion.still_frames = count(state.scene_motion.any(), motion_before.still_frames);
  state.scene_motion.still_light_frames =
      count(state.scene_motion.light_changes(), motion_before.still_light_frames);
  state.has_previous = true;
  state.half_constants = at_half_size(state.constants);
  state.constants_buffers.upload(state.constants, state.half_constants);
  if (!compiled.plan.execute(canceled)) {
    state.constants = before;
    state.has_previous = had_previous;
    state.clock.age = age;
    --state.sample_index;
    state.stale = true;
    return std::nullopt;
  }
  state.has_buffers = compiled.plan.keeps_images();
  if (state.clock.samples == 0) {
    state.clock.first_counts = !leaves_samples_out(compiled.inputs);
  }
  ++state.clock.samples;

  Frame frame = state.output();
  if (state.parts.shader_reload) {
    draw_text(state.parts.shader_reload->error(), frame.rgba, frame.width, frame.height);
  }
  frame.samples = state.clock.samples;
  if (compiled.outputs.radiance_cache) {
    frame.radiance_cache = radiance_cache_use(compiled.plan, *compiled.outputs.radiance_cache);
  }
  frame.converged = !needs_frame();
  frame.new_buffers = is_new;
  if (moves) {
    const std::chrono::duration<float, std::milli> posing = posed - start;
    frame.passes.push_back({"pose", protocol::PassKind::host, posing.count()});
  }
  for (const auto& timing : compiled.plan.timings()) {
    if (timing.milliseconds < 0.0f) continue;
    const auto kind = timing.host ? protocol::PassKind::host : protocol::PassKind::device;
    // Strips of rays are passes of one name.
    const auto known = std::ranges::find(frame.passes, timing.name, &PassTime::name);
    if (known == frame.passes.end()) {
      frame.passes.push_back({timing.name, kind, timing.milliseconds});
    } else {
      known->milliseconds += timing.milliseconds;
    }
  }
  const auto elapsed = std::chrono::steady_clock::now() - start;
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
