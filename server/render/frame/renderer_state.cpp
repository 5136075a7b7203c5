#include "render/frame/renderer_state.hpp"

#include <utility>

#include "render/frame/buffer_list.hpp"
#include "render/frame/probe.hpp"
#include "render/passes/sampling/plan_samples.hpp"
#include "render/passes/shading/draw_shading.hpp"
#include "render/views/debug_view.hpp"
#include "render/views/view_colors.hpp"

namespace heliograph::render {

void choose_reference(protocol::Settings& settings) {
  protocol::Settings::Reference& reference = settings.reference;
  if (reference.use != protocol::ReferenceUse::automatic) return;
  const bool traces = settings.indirect.enabled;
  reference.use = traces ? protocol::ReferenceUse::when_static : protocol::ReferenceUse::off;
  if (traces) reference.scope = protocol::ReferenceScope::full;
}

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
  if (parts.device.is_cpu()) {
    compiled.reset();
  } else if (compiled) {
    discarded = std::move(compiled);
  }
  has_buffers = false;
  has_previous = false;
  sample_index = 0;
  restart_accumulation();
}

void Renderer::State::free_frame_plan() {
  compiled.reset();
  discarded.reset();
}

CompiledFrame& Renderer::State::frame_plan() {
  if (compiled) return *compiled;
  discarded.reset();
  const Section& section = moving->section();
  if (!section.planes.empty()) section_tracer.emplace(*parts.tracer, parts.programs, section);
  const FrameInputs inputs{parts.programs,
                           *scene,
                           moving->tables(),
                           section.planes.empty() ? *parts.tracer : *section_tracer,
                           moving->structure(),
                           constants,
                           half_constants,
                           settings,
                           clock,
                           *moving,
                           scene_motion,
                           all_buffers,
                           parts.split_sum_table,
                           parts.sheen_table,
                           parts.ltc_table,
                           extent};
  compiled = std::make_unique<CompiledFrame>(parts, inputs, constants_buffers, extent,
                                             buffers_needed(), jpeg);
  compiled->plan.set_drawn(drawn());
  new_plan = true;
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
  explode(changed.view.explode);
  settings = changed;
  if (includes(scope, protocol::ResetScope::structure)) {
    discard_frame_plan();
    moving->set_plain(is_plain(settings));
  }
  stale = true;
  if (includes(scope, protocol::ResetScope::history)) has_previous = false;
  if (includes(scope, protocol::ResetScope::accumulation)) restart_accumulation();
}

void Renderer::State::explode(float amount) {
  // The plan refers to the structure of a scene that comes apart, or together.
  if ((amount > 0.0f) != (settings.view.explode > 0.0f)) free_frame_plan();
  if (moving->set_explosion(amount)) discard_frame_plan();
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
  FloatImage values = read_image(image->whole, image->drawn);
  fill_in_weight(*compiled, view.buffer->name, values);
  return extract(view, values,
                 {constants, exposure_factor(compiled->plan, compiled->outputs.exposure)});
}

std::optional<JpegRequest> Renderer::State::next_jpeg() const {
  const bool encodes = requested_jpeg && compiled->encoded && shows_output() &&
                       can_scale_jpeg(extent, requested_jpeg->percent);
  return encodes ? requested_jpeg : std::nullopt;
}

/// Of the frame that was finished last, which came as that JPEG; none: as pixels.
Frame Renderer::State::output(const std::optional<JpegRequest>& made) {
  if (!shows_output()) {
    const std::string& shown = settings.view.buffer;
    if (const auto values = read(shown)) return visualise(shown, *values);
  }
  Frame frame;
  frame.width = extent.width;
  frame.height = extent.height;
  if (made) frame.jpeg = read_jpeg(compiled->plan, *compiled->encoded, *made);
  // A frame that is canceled, as on processors, leaves none to read later.
  if (!made || parts.device.is_cpu()) {
    frame.rgba = compiled->plan.read();
  } else if (frame.jpeg.bytes.empty()) {
    // What the image shows may be the next frame, which has begun.
    frame.rgba = read_unencoded(compiled->plan, *compiled->encoded);
  }
  return frame;
}

/// Whether anything moved.
bool Renderer::State::pose() {
  bool moves = moving->advance();
  // Without a frame before there is no motion since.
  if (!has_previous) moves |= moving->advance();
  return moves;
}

/// Of the next frame.
void Renderer::State::make_constants(const shared::FrameConstants& before) {
  constants = make_frame_constants(camera, settings, *moving, {.drawn = drawn(), .shown = extent},
                                   sample_index++, has_previous ? &before : nullptr);
  const SceneMotion motion_before = scene_motion;
  scene_motion = render::scene_motion(*moving, constants, has_previous ? &before : nullptr);
  const auto count = [&](bool changes, std::uint32_t still) {
    if (changes) return 0u;
    return has_previous && still < ~0u ? still + 1 : ~0u;
  };
  scene_motion.still_frames = count(scene_motion.any(), motion_before.still_frames);
  scene_motion.still_light_frames =
      count(scene_motion.light_changes(), motion_before.still_light_frames);
  has_previous = true;
  half_constants = at_half_size(constants);
  constants_buffers[compiled->plan.slot()].upload(constants, half_constants);
}

/// Of the frame that has begun last.
void Renderer::State::count_sample() {
  if (clock.samples == 0) clock.first_counts = !leaves_samples_out(compiled->inputs);
  begun.back().samples = ++clock.samples;
}

/// Where no more than the camera differs, the next frame changes nothing that the device reads for
/// the one that it works on. What is read after a frame but its output must be read before the
/// next.
bool Renderer::State::can_begin_another() const {
  return compiled && !new_plan && !parts.device.is_cpu() && !parts.shader_reload &&
         !moving->needs_advance() && has_previous && shows_output() && !keeps_buffers &&
         settings.reference.use != protocol::ReferenceUse::always &&
         compiled->plan.can_begin_another();
}

void Renderer::State::list_passes(const Begun& begun, Frame& frame) const {
  if (begun.posing) frame.passes.push_back({"pose", protocol::PassKind::host, *begun.posing});
  for (const auto& timing : compiled->plan.timings()) {
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
}

}  // namespace heliograph::render
