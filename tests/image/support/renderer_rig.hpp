#pragma once

#include "scene/camera.hpp"
#include "tests/support/engine.hpp"
#include "tests/support/image_comparison.hpp"
#include "tests/support/scene_builder.hpp"
#include "tests/support/scene_files.hpp"
#include "tests/support/similarity.hpp"

namespace heliograph::test {

/// A renderer with a scene and a camera, as a session uses it.
class RendererRig {
 public:
  RendererRig(std::shared_ptr<const scene::Scene> scene, const scene::Environment& environment,
              const scene::Camera& camera, std::uint32_t width, std::uint32_t height,
              const std::string& tracer = "auto")
      : renderer(engine(tracer)) {
    renderer.set_scene(engine(tracer).upload(std::move(scene), environment));
    renderer.set_camera(camera);
    renderer.set_size(width, height);
  }

  void apply(const protocol::Settings& settings) {
    if (!renderer.set_settings(settings)) throw std::runtime_error("settings refused");
  }
  /// Renders until `samples` samples are accumulated.
  render::Frame accumulate(std::uint32_t samples) {
    render::Frame frame;
    do frame = renderer.render();
    while (frame.samples < samples);
    return frame;
  }
  render::FloatImage capture(const char* buffer) { return renderer.capture(buffer).value(); }

  render::Renderer renderer;
};

inline glm::vec3 rgb(const render::FloatImage& image, std::uint32_t x, std::uint32_t y) {
  const float* values = &image.rgba[(std::size_t{y} * image.width + x) * 4];
  return {values[0], values[1], values[2]};
}

}  // namespace heliograph::test
