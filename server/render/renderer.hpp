#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
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
};

struct DeviceInfo {
  std::string name;
  std::string driver;
  protocol::DeviceType type;
};

/// A scene and its environment on the device, with its acceleration structure. Shared, immutable.
class SceneResources;

/// Memory of the tables, images and the acceleration structure, not of the environment.
std::uint64_t memory_bytes(const SceneResources& resources);

/// Told as an upload proceeds: stage name and fraction of the whole, 0..1.
using UploadProgress = std::function<void(std::string_view stage, float fraction)>;

/// One device with its programs: made once, shared by every renderer.
class Engine {
 public:
  /// @throws gpu::GpuError with the reasons when no device will do
  explicit Engine(const EngineOptions& options);
  ~Engine();
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  const DeviceInfo& device() const;
  protocol::TracerKind tracer() const;
  std::uint32_t max_image_size() const;  // pixels, either side
  std::uint64_t validation_messages() const;

  /// Uploads, prefilters the environment and builds the acceleration structure.
  /// May run on any thread, beside rendering. What `progress` throws ends it and comes out.
  std::shared_ptr<const SceneResources> upload(std::shared_ptr<const scene::Scene> scene,
                                               const scene::Environment& environment,
                                               const UploadProgress& progress = {});

  struct Parts;
  Parts& parts() { return *parts_; }

 private:
  std::unique_ptr<Parts> parts_;
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
  std::vector<float> rgba;
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
  void set_size(std::uint32_t width, std::uint32_t height);
  void set_camera(const scene::Camera& camera);
  /// Poses the scene by a clip of it, or as at rest when `clip` is empty, where set_scene leaves it.
  /// Takes effect with the next frame. Motion restarts the resting picture, not the histories.
  protocol::Result<void> set_pose(std::string_view clip, double seconds);
  /// Forgets every history and starts the random sequences anew: what follows are the frames of a
  /// fresh renderer.
  void cut();
  /// Time from frame to frame, which histories are measured by; 1/60 s until told otherwise.
  void set_frame_seconds(float seconds);
  /// Refused when a new `view.buffer` names no buffer; then nothing is applied.
  protocol::Result<void> set_settings(const protocol::Settings& settings);

  /// False once a resting picture has all its samples and nothing has changed since.
  bool needs_frame() const;
  /// Draws the next frame; the empty scene is black.
  Frame render();

  /// The work behind the last frame's pass times; slow, for measurements.
  std::vector<PassWork> work() const;

  /// Every buffer that `view.buffer` and `capture` accept, "output" first.
  const std::vector<BufferInfo>& buffers() const;
  /// The buffer as of the last frame, raw values (linear radiance, metres, unit vectors ...).
  protocol::Result<FloatImage> capture(std::string_view buffer);
  /// The same as a picture for people: the debug view of that buffer, as streamed.
  protocol::Result<Frame> capture_view(std::string_view buffer);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// What Vulkan offers on this machine, a line per driver file and device with the reason why each
/// was or was not chosen. Never throws.
std::string describe_devices(const EngineOptions& options);

}  // namespace heliograph::render
