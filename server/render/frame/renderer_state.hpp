#pragma once

#include <algorithm>
#include <chrono>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "render/api/renderer.hpp"
#include "render/frame/compiled_frame.hpp"
#include "render/frame/frame_constants.hpp"
#include "render/passes/post/present.hpp"
#include "render/passes/section/section_tracer.hpp"
#include "render/resources/moving/moving_scene.hpp"
#include "render/resources/moving/scene_motion.hpp"

namespace heliograph::render {

/// `automatic` becomes one of the others.
void choose_reference(protocol::Settings& settings);

struct Renderer::State {
  State(Engine::Parts& engine, std::shared_ptr<const SceneResources> empty)
      : parts(engine),
        nothing(std::move(empty)),
        constants_buffers{FrameConstantsBuffers(engine.device),
                          FrameConstantsBuffers(engine.device)} {
    choose_reference(settings);
  }

  /// A frame that has begun.
  struct Begun {
    std::chrono::steady_clock::time_point start;
    std::optional<float> posing;  // milliseconds; absent: nothing moved
    bool new_buffers = false;
    std::optional<JpegRequest> jpeg;
    bool only_shown = false;    // is_only_shown()
    std::uint32_t samples = 0;  // with it
  };

  /// A GPU's driver takes long to free its memory, which comes before another plan is made.
  void discard_frame_plan();
  /// At once: what it refers to is replaced.
  void free_frame_plan();
  CompiledFrame& frame_plan();
  VkExtent2D drawn() const;
  void set_drawn();
  void change_settings(const protocol::Settings& changed);
  void explode(float amount);
  void use_newest_shaders();
  bool can_begin_another() const;
  void count_sample();
  Frame output(const std::optional<JpegRequest>& made);
  std::optional<JpegRequest> next_jpeg() const;
  /// Whether all buffers of the next frame are kept: a view of one of them needs them, too.
  bool buffers_needed() const {
    return keeps_buffers ||
           (!shows_output() && settings.view.buffer != present_buffers.radiance.name);
  }
  bool shows_output() const { return settings.view.buffer == present_buffers.output.name; }
  std::optional<FloatImage> read(std::string_view name);
  bool pose();
  void make_constants(const shared::FrameConstants& before);
  void list_passes(const Begun& begun, Frame& frame) const;
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
  FrameConstantsSlots constants_buffers;
  shared::FrameConstants constants{};
  shared::FrameConstants half_constants{};  // at_half_size()
  bool has_previous = false;
  std::uint32_t sample_index = 0;  // frames since the history was invalidated
  FrameClock clock;
  SceneMotion scene_motion;
  bool keeps_buffers = true;          // as requested
  bool all_buffers = true;            // of the frame that begins
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
  std::optional<JpegRequest> requested_jpeg;
  std::optional<JpegRequest> jpeg;  // of the newest frame that has begun; none: pixels come back

  std::optional<SectionTracer> section_tracer;  // of a plan with section planes
  std::unique_ptr<CompiledFrame> compiled;      // absent until it is needed: see frame_plan()
  std::unique_ptr<CompiledFrame> discarded;     // the one before, until another one is made
  bool new_plan = false;                        // no frame has begun with it

  std::deque<Begun> begun;  // those that are not finished, the oldest first
};

}  // namespace heliograph::render
