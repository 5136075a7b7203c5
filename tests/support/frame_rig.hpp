#pragma once

#include "render/api/frame_values.hpp"
#include "render/frame/frame.hpp"
#include "render/frame/frame_constants.hpp"
#include "render/resources/moving/moving_scene.hpp"
#include "render/resources/moving/scene_motion.hpp"
#include "tests/support/engine.hpp"
#include "tests/support/scene_builder.hpp"

namespace heliograph::test {

/// With ambient occlusion in place of indirect light.
inline protocol::Settings without_indirect() {
  protocol::Settings settings;
  settings.indirect.enabled = false;
  return settings;
}

struct RigOptions {
  VkExtent2D extent{64, 64};
  scene::Environment environment = scene::constant_environment(glm::vec3(1.0f));
  protocol::Settings settings = without_indirect();
  std::string tracer = "auto";
  std::optional<VkExtent2D> shown = std::nullopt;  // where frames are drawn smaller
};

/// A scene, a camera and a frame plan in which a test declares single passes.
class FrameRig {
 public:
  FrameRig(std::shared_ptr<const scene::Scene> scene, const scene::Camera& camera,
           const RigOptions& options = {});

  gpu::FramePlan& plan() { return plan_; }
  const render::FrameInputs& inputs() const { return inputs_; }
  VkDescriptorSet frame_set() const { return frame_set_; }
  VkDescriptorSet scene_set() const { return scene_set_; }
  const shared::FrameConstants& constants() const { return constants_; }
  const render::SceneResources& scene() const { return moving_.resources(); }
  render::MovingScene& moving() { return moving_; }

  /// Sets the camera of the next frame; the current one becomes the previous one.
  void set_view(const scene::Camera& camera, std::uint32_t sample = 0);
  /// From now on frames are drawn in the upper left part of the images.
  void draw_smaller(VkExtent2D drawn, const scene::Camera& camera);
  /// The next set_view() has no view before it.
  void invalidate_history() { has_view_ = false; }
  void set_settings(const protocol::Settings& settings) { settings_ = settings; }
  /// Number of samples already accumulated.
  void set_accumulated(std::uint32_t samples) { clock_.samples = samples; }
  /// From now on samples are path traced.
  void let_reference_take_over() { clock_.hybrid_samples = clock_.samples; }
  /// Time since the previous frame, in seconds.
  void set_seconds(float seconds) { clock_.seconds = seconds; }
  /// Whether more of frames from the next one on is read than what they show, as at first.
  void read_all_buffers(bool all) { all_buffers_ = all; }
  /// Motion of lights and geometry in the next frame.
  void set_scene_motion(const render::SceneMotion& motion) { scene_motion_ = motion; }

  /// An input image: `texels` in the format's layout, one per pixel, top row first.
  template <typename Texel>
  gpu::ImageRef input(const std::string& name, VkFormat format, const std::vector<Texel>& texels) {
    const gpu::ImageRef image = plan_.image(name, format);
    plan_.get(image).upload(std::as_bytes(std::span(texels)));
    return image;
  }
  /// Overwrites an image between frames.
  template <typename Texel>
  void fill(gpu::ImageRef image, const std::vector<Texel>& texels) {
    plan_.get(image).upload(std::as_bytes(std::span(texels)));
  }

  /// Compiles at the first call, then runs one frame.
  void run();
  /// Contents after the last frame.
  render::FloatImage read(gpu::ImageRef image) const;

 private:
  render::Engine::Parts& parts_;
  render::MovingScene moving_;
  RigOptions options_;
  protocol::Settings settings_;
  shared::FrameConstants constants_{};
  shared::FrameConstants half_constants_{};
  render::FrameClock clock_;
  render::SceneMotion scene_motion_;
  bool all_buffers_ = true;
  bool has_view_ = false;
  bool compiled_ = false;
  render::FrameConstantsBuffers constants_buffers_;
  gpu::DescriptorPool pool_;
  VkDescriptorSet frame_set_ = VK_NULL_HANDLE;
  VkDescriptorSet half_frame_set_ = VK_NULL_HANDLE;
  VkDescriptorSet scene_set_ = VK_NULL_HANDLE;
  render::FrameInputs inputs_;
  gpu::FramePlan plan_;
};

/// RGBA of one pixel.
inline glm::vec4 texel(const render::FloatImage& image, std::uint32_t x, std::uint32_t y) {
  const float* values = &image.rgba[(std::size_t{y} * image.width + x) * 4];
  return {values[0], values[1], values[2], values[3]};
}

}  // namespace heliograph::test
