#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include "gpu/pipelines/shader_report.hpp"
#include "protocol/messages/kinds.hpp"
#include "scene/environment.hpp"
#include "scene/scene.hpp"

namespace heliograph::render {

/// Whether the device encodes frames as JPEG for viewers.
enum class JpegEncoding {
  automatic,  // on GPUs: a processor is faster with its own instructions
  on,
  off,
};

/// Whether textures of KTX2 files stay compressed on the device, as BC7.
enum class CompressedTextures {
  automatic,  // on GPUs that read it: a processor samples RGBA faster
  on,         // on any device that reads it
  off,
};

struct EngineOptions {
  std::string device;           // part of a name, for choose_devices() a list; empty: the best
  std::string tracer = "auto";  // auto, or a protocol::TracerKind
  bool validation = false;      // Vulkan validation layers on, every message an error
  std::filesystem::path cache_folder;   // pipeline cache; empty: none
  bool host_kernels = true;             // on devices that are processors, where a pass has one
  bool as_gpu = false;                  // treat a processor as a GPU, for tests of that path
  std::filesystem::path shader_folder;  // GLSL compiled at run time; empty: the embedded shaders.
                                        // Host kernels, which are not made of them, are off then.
  JpegEncoding jpeg = JpegEncoding::automatic;
  CompressedTextures compressed_textures = CompressedTextures::automatic;
};

/// What came of shader files that had changed.
using gpu::ShaderReport;

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

/// Progress of an upload: stage name and fraction of the whole, 0..1.
using UploadProgress = std::function<void(std::string_view stage, float fraction)>;

/// One device with its programs, shared by every renderer. After a gpu::DeviceLost from any use of
/// the device, `recreate` makes another one.
class Engine {
 public:
  /// @throws gpu::GpuError with the reasons when no device can be used
  explicit Engine(const EngineOptions& options);
  ~Engine();
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  DeviceInfo device() const;
  protocol::TracerKind tracer() const;
  /// Whether Renderer::request_jpeg() has an effect.
  bool encodes_jpeg() const;
  std::uint32_t max_image_size() const;  // pixels, either side
  std::uint64_t validation_messages() const;
  /// So many frames of different renderers the device has at the same time: on GPUs with queues for
  /// compute alone one for each and half as many that wait, so that no queue is idle while the
  /// processor begins another frame; otherwise 1.
  std::size_t frames_at_once() const;
  /// How often commands were given to the device since the start, to lost ones before it too.
  std::uint64_t submissions() const;
  /// Called on a thread of its own whenever files of the shader folder have changed, and at once
  /// where they do not compile now.
  void on_shader_change(std::function<void(const ShaderReport&)> listener);
  /// Why the shader folder's newest files are not in use, a line per error; empty: they are.
  std::string shader_error() const;

  /// Uploads, prefilters the environment and builds the acceleration structure.
  /// May run on any thread, beside rendering. What `progress` throws ends the upload and is passed
  /// on.
  std::shared_ptr<const SceneResources> upload(std::shared_ptr<const scene::Scene> scene,
                                               const scene::Environment& environment,
                                               const UploadProgress& progress = {});
  std::shared_ptr<const SceneResources> upload(
      std::shared_ptr<const scene::Scene> scene,
      std::shared_ptr<const scene::Environment> environment, const UploadProgress& progress = {});
  /// The same of a scene that is given away: the pixels of its images that came from files are
  /// freed as soon as they are on the device, so that memory never holds them twice. `first`: the
  /// same scene without its textures, which shares its geometry and acceleration structure; null,
  /// or on a device that was lost meanwhile: nothing is shared.
  std::shared_ptr<const SceneResources> upload_and_free_pixels(
      std::unique_ptr<scene::Scene> scene, std::shared_ptr<const scene::Environment> environment,
      const UploadProgress& progress = {}, std::shared_ptr<const SceneResources> first = nullptr);

  /// Nothing on black: what is rendered before there is a scene. One for all renderers.
  std::shared_ptr<const SceneResources> empty_scene();

  /// Uploads and prefilters an environment, or returns the one that is in use already. May run on
  /// any thread, beside rendering.
  std::shared_ptr<const LitEnvironment> prefilter(scene::Environment environment);

  /// Makes the device and its programs again. There must be no renderer; what was uploaded before
  /// may still be referenced but must not be rendered. @throws gpu::GpuError
  void recreate();
  /// Whether it is on the current device.
  bool owns(const SceneResources& resources) const;
  bool owns(const LitEnvironment& environment) const;
  /// The same on the current device.
  std::shared_ptr<const SceneResources> renew(const SceneResources& lost);
  std::shared_ptr<const LitEnvironment> renew(const LitEnvironment& lost);

  struct Parts;
  Parts& parts() { return *parts_; }

 private:
  std::shared_ptr<Parts> current() const;
  std::shared_ptr<const SceneResources> upload_images(
      std::shared_ptr<const scene::Scene> scene,
      std::shared_ptr<const scene::Environment> environment, const UploadProgress& progress,
      const std::function<void(std::size_t image)>& image_done,
      std::shared_ptr<const SceneResources> first = nullptr);

  const EngineOptions options_;
  mutable std::mutex mutex_;  // guards what follows
  std::function<void(const ShaderReport&)> shader_listener_;
  std::shared_ptr<Parts> parts_;
  std::uint64_t submissions_before_ = 0;  // to devices that were lost
};

/// What Vulkan offers on this machine, a line per driver file and device with the reason why each
/// was or was not chosen. Never throws.
std::string describe_devices(const EngineOptions& options);

}  // namespace heliograph::render
