#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "protocol/messages/frame_depth.hpp"
#include "protocol/result.hpp"
#include "protocol/settings/settings.hpp"
#include "render/api/engine.hpp"
#include "render/api/frame_values.hpp"
#include "render/api/section.hpp"
#include "scene/scene.hpp"

namespace heliograph::render {

/// Of `side` pixels those that are drawn at `scale`, 0 to 1: at least one.
std::uint32_t drawn_side(std::uint32_t side, float scale);

/// Why lights or materials are others than before: a client has edited them, or a clip that plays
/// has come to another moment.
enum class PartChange { edit, animation };

/// Renders one view of a scene: camera, settings, size and history of one session.
/// Not thread safe: one thread calls it.
class Renderer {
 public:
  /// Shows `scene`, as set_scene says. Any thread may call it.
  explicit Renderer(Engine& engine, std::shared_ptr<const SceneResources> scene = nullptr);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Null is the empty scene.
  void set_scene(std::shared_ptr<const SceneResources> scene);
  /// Other lights, in the default pose, and other values of materials than those of the scene's
  /// file, for this renderer alone. Lights: those of the scene, of the same kinds, then any others,
  /// which no clip moves. Materials: as many as the scene has, with the same textures and alpha;
  /// Material::layer counts `layers`, of which the first adds nothing; none: the scene's. Rays that
  /// pass transmissive surfaces go by the file's. set_scene brings back the file's. Lights that
  /// only move keep the histories, and so does all that a clip animates: it is rectified as other
  /// motion is.
  void set_lights(std::span<const shared::Light> lights, PartChange change = PartChange::edit);
  void set_materials(std::span<const shared::Material> materials,
                     std::span<const shared::MaterialLayer> layers = {},
                     PartChange change = PartChange::edit);
  /// Another environment than the scene's own; null: its own again.
  void set_environment(std::shared_ptr<const LitEnvironment> environment);
  /// Leaves out the instances for which `hidden` is true, one for each of the scene's; empty: none.
  /// Their shadows and reflections are gone, too. set_scene shows all again.
  void set_hidden(std::vector<bool> hidden);
  /// Cuts the scene open by planes; without any it is whole. With planes rays find what the camera
  /// sees, whatever gbuffer.source says. set_scene makes it whole again.
  /// @throws std::invalid_argument for more than shared::most_section_planes
  void set_section(Section section);
  /// Draws an outline around what these instances cover; set_scene ends that. Histories go on.
  /// Frames of the path traced reference alone, which know no instances, have none.
  void set_selected(std::span<const std::uint32_t> instances);
  /// Of the finished frame, pixels.
  void set_size(std::uint32_t width, std::uint32_t height);
  /// The fraction of width and height at which frames are drawn, 0 to 1: what is drawn smaller is
  /// reconstructed at full size from the jittered samples of several frames, and does not
  /// accumulate. All histories continue. The path traced reference alone is drawn at full size.
  void set_draw_scale(float scale);
  void set_camera(const scene::Camera& camera);
  /// Poses the scene by a clip of it, or by its default pose when `clip` is empty, where set_scene
  /// leaves it. Takes effect with the next frame. Motion restarts accumulation, not the histories.
  protocol::Result<void> set_pose(std::string_view clip, double seconds);
  /// Discards every history and restarts the random sequences: the next frames are those of a new
  /// renderer.
  void invalidate_history();
  /// Discards all state that frames leave behind: the next frames are those of a new renderer.
  void reset();
  /// Time from frame to frame, which the length of histories is measured by; 1/60 s by default.
  void set_frame_seconds(float seconds);
  /// Refused as check_buffer_name says. Where the passes write no such buffer, the output is shown.
  protocol::Result<void> set_settings(const protocol::Settings& settings);

  /// Whether all buffers can be read after the frames from the next one on, as they can at first:
  /// that takes more memory, and more time while the view moves. Otherwise these: the output, its
  /// radiance, and what was picked from. What frames show does not depend on it.
  void keep_buffers(bool keep);
  /// Whether the last frame kept them.
  bool has_buffers() const;

  /// Whether the next frame would make its programs and images first, which takes far longer than a
  /// frame, and prepare() may do that on another thread: on GPUs with the embedded shaders.
  bool can_prepare() const;
  /// Makes them, on any thread, beside other renderers, while nothing else of this one is called.
  void prepare();
  /// Whether it still has the images that a change has discarded: on GPUs until the next are made.
  /// free_discarded() frees them now, on any thread, like prepare().
  bool has_discarded() const;
  void free_discarded();

  /// False until a frame has begun with the programs and images that the next one is made with: the
  /// first one takes longer.
  bool has_begun() const;

  /// The next frames come as such a JPEG where the engine encodes and the output is shown, and with
  /// pixels only where those cost nothing; absent: they come as pixels. So do frames of more than
  /// 16.8 million pixels that would be made smaller, and those whose JPEG is too long.
  void request_jpeg(std::optional<JpegRequest> request);
  /// The pixels of the last frame, which came without; empty where a change since has discarded
  /// them, or another frame has begun.
  std::vector<std::uint8_t> read_pixels();

  /// False once a static view has all its samples and nothing has changed since.
  bool needs_frame() const;
  /// Renders the next frame; the empty scene is black.
  Frame render();
  /// The same, or no frame if `canceled`, which is asked between and in passes on CPU devices, from
  /// any of their threads, returns true. The next frame then continues the histories of the one
  /// before; until then no buffer is valid.
  std::optional<Frame> render(const std::function<bool()>& canceled);
  /// The first part of render(), up to where nothing is left but to wait for the device: another
  /// renderer of the same engine may begin its frame meanwhile. @returns false where canceled;
  /// otherwise finish() is the next call
  bool begin(const std::function<bool()>& canceled);
  /// Whether the device still works on a frame that has begun: finish() would wait.
  bool in_flight() const;
  /// Whether the next frame may begin before this one is finished, on GPUs: where nothing but the
  /// camera was changed since.
  bool can_begin_another() const;
  /// The part of the time between two frames after which the device has room for another one beside
  /// the one that has begun first; 1: not before that is done.
  float part_before_next() const;
  /// Waits for the frame that has begun first, but no longer. @returns whether it is done
  bool wait_for(std::chrono::nanoseconds time) const;
  /// The second part, of the frame that has begun first.
  Frame finish();

  /// The work behind the last frame's pass times; slow, for measurements.
  std::vector<PassWork> work() const;

  /// Every buffer that there is with these settings and this scene, "output" first.
  const std::vector<BufferInfo>& buffers() const;
  /// The buffer as of the last frame, raw values (linear radiance, metres, unit vectors ...).
  protocol::Result<FloatImage> capture(std::string_view buffer);
  /// The same as colours: the debug view of that buffer, as streamed.
  protocol::Result<Frame> capture_view(std::string_view buffer);
  /// Every buffer of the last frame at one point: fractions of the width and height from the upper
  /// left corner, 0 to 1.
  std::vector<BufferValue> inspect(glm::vec2 point) const;
  /// The surface that the last frame shows there, or none for the background. An error where the
  /// frame has no G-buffer: when it is all path traced.
  protocol::Result<std::optional<SurfacePoint>> pick(glm::vec2 point) const;
  /// The camera of the last frame and its surfaces, coarsely; nothing for cameras without
  /// perspective and where the frame has no G-buffer.
  std::optional<protocol::FrameDepth> depth() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace heliograph::render
