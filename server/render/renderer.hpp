#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/kinds.hpp"
#include "protocol/result.hpp"
#include "protocol/settings.hpp"
#include "scene/environment.hpp"
#include "scene/scene.hpp"

namespace heliograph::render {

struct EngineOptions {
  std::string device;                  // part of a device's name, or empty: the best there is
  std::string tracer = "auto";         // auto, or a protocol::TracerKind
  bool validation = false;             // Vulkan validation layers on, every message an error
  std::filesystem::path cache_folder;  // pipeline cache; empty: none
  bool host_kernels = true;            // on devices that are processors, where a pass has one
  bool as_gpu = false;                 // treat a processor as a GPU, for tests of that path
};

struct DeviceInfo {
  std::string name;
  std::string driver;
  protocol::DeviceType type;
};

/// A scene and its environment on the device, with its acceleration structure. Shared, immutable.
class SceneResources;
/// An environment on the device, filtered. Shared, immutable.
class LitEnvironment;

/// The scene that was uploaded.
const std::shared_ptr<const scene::Scene>& scene_of(const SceneResources& resources);
/// Memory of the tables, images and the acceleration structure, not of the environment.
std::uint64_t memory_bytes(const SceneResources& resources);

/// Told as an upload proceeds: stage name and fraction of the whole, 0..1.
using UploadProgress = std::function<void(std::string_view stage, float fraction)>;

/// One device with its programs, shared by every renderer. Where gpu::DeviceLost is thrown, by
/// whatever works on the device, `recreate` makes another one.
class Engine {
 public:
  /// @throws gpu::GpuError with the reasons when no device will do
  explicit Engine(const EngineOptions& options);
  ~Engine();
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  DeviceInfo device() const;
  protocol::TracerKind tracer() const;
  std::uint32_t max_image_size() const;  // pixels, either side
  std::uint64_t validation_messages() const;

  /// Uploads, prefilters the environment and builds the acceleration structure.
  /// May run on any thread, beside rendering. What `progress` throws ends it and comes out.
  std::shared_ptr<const SceneResources> upload(std::shared_ptr<const scene::Scene> scene,
                                               const scene::Environment& environment,
                                               const UploadProgress& progress = {});
  std::shared_ptr<const SceneResources> upload(
      std::shared_ptr<const scene::Scene> scene,
      std::shared_ptr<const scene::Environment> environment, const UploadProgress& progress = {});
  /// The same of a scene that is given away: its images that came from files let go of their pixels
  /// as soon as these are on the device, so that they are never there twice.
  std::shared_ptr<const SceneResources> upload(
      std::unique_ptr<scene::Scene> scene, std::shared_ptr<const scene::Environment> environment,
      const UploadProgress& progress = {});

  /// Uploads and prefilters an environment, or finds it where it is in use already. May run on any
  /// thread, beside rendering.
  std::shared_ptr<const LitEnvironment> prefilter(scene::Environment environment);

  /// Makes the device and its programs anew. There must be no renderer; what was uploaded before
  /// may still be held but is of no use any more. @throws gpu::GpuError
  void recreate();
  /// Whether it lives on the present device.
  bool owns(const SceneResources& resources) const;
  bool owns(const LitEnvironment& environment) const;
  /// The same on the present device.
  std::shared_ptr<const SceneResources> renew(const SceneResources& lost);
  std::shared_ptr<const LitEnvironment> renew(const LitEnvironment& lost);

  struct Parts;
  Parts& parts() { return *parts_; }

 private:
  std::shared_ptr<Parts> present() const;
  std::shared_ptr<const SceneResources> upload(
      std::shared_ptr<const scene::Scene> scene,
      std::shared_ptr<const scene::Environment> environment, const UploadProgress& progress,
      const std::function<void(std::size_t image)>& image_done);

  const EngineOptions options_;
  mutable std::mutex mutex_;  // guards parts_
  std::shared_ptr<Parts> parts_;
};

struct PassTime {
  std::string name;
  protocol::PassKind kind;  // device or host
  float milliseconds;
};

/// What a pass of the last frame had to touch: bytes of the images that it reads and writes, and
/// the rays of its stream (0: it works on none).
struct PassWork {
  std::string name;
  std::uint64_t image_bytes;
  std::uint64_t rays;
};

/// Four floats a pixel, row 0 on top; what the channels mean is the buffer's description.
struct FloatImage {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<float> rgba{};
  std::uint32_t channels = 4;  // the first so many of the four are the buffer's
  bool counts = false;         // whole numbers from 0
};

/// The value of one buffer at one pixel.
struct BufferValue {
  std::string name;
  std::vector<float> channels;
  std::string unit;  // empty: plain numbers, or channels of different kinds
};

/// What is seen at one point of the picture, in world space, metres.
struct SurfacePoint {
  std::uint32_t instance;  // of the scene
  glm::vec3 position;
  glm::vec3 normal;  // of the triangle, toward the camera
  float distance;    // from the eye; along the view for cameras without perspective
};

struct BufferInfo {
  std::string name;
  std::string description;
};

/// One rendered frame, ready for an encoder.
struct Frame {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<std::uint8_t> rgba;  // sRGB, alpha 255, row 0 on top, tightly packed
  std::uint32_t samples = 0;       // accumulated in this picture
  bool converged = false;          // another frame would show the same
  float milliseconds = 0.0f;       // whole frame, wall clock
  std::vector<PassTime> passes;
};

/// Draws one view of a scene: camera, settings, size and history of one session.
/// Not thread safe: one thread calls it.
class Renderer {
 public:
  explicit Renderer(Engine& engine);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Null is the empty scene, which every renderer starts with.
  void set_scene(std::shared_ptr<const SceneResources> scene);
  /// Other lights, as at rest, and other values of materials than those of the scene's file, for
  /// this renderer alone: as many as the scene has, of the same kinds, with the same textures and
  /// alpha. set_scene brings back the file's. Lights that only move keep the histories.
  void set_lights(std::span<const shared::Light> lights);
  void set_materials(std::span<const shared::Material> materials);
  /// Another environment than the scene's own; null: its own again.
  void set_environment(std::shared_ptr<const LitEnvironment> environment);
  void set_size(std::uint32_t width, std::uint32_t height);
  void set_camera(const scene::Camera& camera);
  /// Poses the scene by a clip of it, or as at rest when `clip` is empty, where set_scene leaves
  /// it. Takes effect with the next frame. Motion restarts the resting picture, not the histories.
  protocol::Result<void> set_pose(std::string_view clip, double seconds);
  /// Forgets every history and starts the random sequences anew: what follows are the frames of a
  /// fresh renderer.
  void cut();
  /// As if nothing had been drawn before: what follows is what another renderer in the same state
  /// would draw, whatever this one drew.
  void start_anew();
  /// Time from frame to frame, which histories are measured by; 1/60 s until told otherwise.
  void set_frame_seconds(float seconds);
  /// Refused as check_buffer_name says. While they make no buffer to view, the picture is shown.
  protocol::Result<void> set_settings(const protocol::Settings& settings);

  /// False once a resting picture has all its samples and nothing has changed since.
  bool needs_frame() const;
  /// Draws the next frame; the empty scene is black.
  Frame render();

  /// The work behind the last frame's pass times; slow, for measurements.
  std::vector<PassWork> work() const;

  /// Every buffer that there is with these settings and this scene, "output" first.
  const std::vector<BufferInfo>& buffers() const;
  /// The buffer as of the last frame, raw values (linear radiance, metres, unit vectors ...).
  protocol::Result<FloatImage> capture(std::string_view buffer);
  /// The same as a picture for people: the debug view of that buffer, as streamed.
  protocol::Result<Frame> capture_view(std::string_view buffer);
  /// Every buffer of the last frame at one point of the picture: shares of its width and height
  /// from the upper left corner, 0 to 1.
  std::vector<BufferValue> inspect(glm::vec2 point) const;
  /// The surface that the last frame shows there; nothing: the background. An error where the
  /// frame keeps no surfaces: when it is all path traced.
  protocol::Result<std::optional<SurfacePoint>> pick(glm::vec2 point) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// What Vulkan offers on this machine, a line per driver file and device with the reason why each
/// was or was not chosen. Never throws.
std::string describe_devices(const EngineOptions& options);

}  // namespace heliograph::render
