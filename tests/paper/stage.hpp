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
};

/// A run of frames in lockstep: frame i shows the clip at i * frame_seconds.
struct Shot {
  Movement movement = Movement::still;
  int frames = 60;
  int compared = 3;  // of the last frames, which are held against the truth
  float frame_seconds = 1.0f / 60.0f;
};

/// Where the truth comes from.
enum class Truth {
  reference,    // the path tracer along the hybrid's own light paths
  accumulated,  // the hybrid without denoisers, averaged: tells denoising errors alone
};

/// One scene with one swept value, on the device.
class Stage {
 public:
  /// Generates the scene and reads it back from a file, as any user's.
  /// @throws std::exception
  Stage(render::Engine& engine, const std::string& scene, const scenes::Sweep& sweep,
        const StageOptions& options);

  /// Plays the whole shot and gives its last `compared` frames.
  std::vector<render::Frame> play(const protocol::Settings& settings, const Shot& shot) const;

  /// What those frames should have shown, `samples` per pixel.
  std::vector<render::Frame> truth(Truth source, const Shot& shot, int samples) const;

  /// Plays the whole shot and gives every frame's times; pictures are left out.
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
