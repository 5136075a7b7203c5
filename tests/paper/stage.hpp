#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "render/api/renderer.hpp"
#include "scene/environment.hpp"
#include "scene/scene.hpp"
#include "scenes/generator/gltf/document.hpp"
#include "tests/paper/cases.hpp"

namespace heliograph::paper {

struct StageOptions {
  std::uint32_t width = 320;
  std::uint32_t height = 180;
  int texture_size = 128;
  float draw_scale = 1.0f;  // of what is compared; ground truth is of full size
};

/// A run of frames in lockstep: frame i shows the clip at i * frame_seconds.
struct Shot {
  Movement movement = Movement::still;
  int frames = 60;
  int compared = 3;  // number of last frames that are compared with ground truth
  float frame_seconds = 1.0f / 60.0f;
};

/// What a technique makes of a shot.
struct Played {
  std::vector<render::Frame> frames;  // the last `compared`
  double rays_per_pixel = 0.0;        // in those frames, on average, without camera rays
};

/// Source of ground truth.
enum class GroundTruth {
  reference,    // the path tracer along the hybrid's own light paths
  full,         // the path tracer with global illumination
  accumulated,  // the mean of the hybrid without denoisers: isolates denoising errors
};

/// One scene with one swept value, on the device.
class Stage {
 public:
  /// Generates the scene and imports it from a file.
  /// @throws std::exception
  Stage(render::Engine& engine, const std::string& scene, const scenes::Sweep& sweep,
        const StageOptions& options);

  /// Renders the whole shot.
  Played play(const protocol::Settings& settings, const Shot& shot) const;

  /// The view at rest after the whole shot: its last frame, and those with more samples of the same
  /// view up to `samples`.
  std::vector<render::Frame> rest(const protocol::Settings& settings, const Shot& shot,
                                  int samples) const;

  /// Ground truth of those frames, `samples` per pixel.
  std::vector<render::Frame> ground_truth(GroundTruth source, const Shot& shot, int samples) const;

  /// Renders the whole shot and returns every frame's timings, without images.
  std::vector<render::Frame> time(const protocol::Settings& settings, const Shot& shot) const;

 private:
  std::unique_ptr<render::Renderer> start(const protocol::Settings& settings,
                                          const Shot& shot) const;
  void show_moment(render::Renderer& renderer, const Shot& shot, int frame) const;

  render::Engine& engine_;
  StageOptions options_;
  std::shared_ptr<const scene::Scene> scene_;
  std::shared_ptr<const render::SceneResources> resources_;
};

}  // namespace heliograph::paper
