#include "tests/support/frame_rig.hpp"

#include <cstring>

#include "render/frame/frame_set.hpp"
#include "render/resources/scene_set.hpp"
#include "render/views/debug_view.hpp"

namespace heliograph::test {

FrameRig::FrameRig(std::shared_ptr<const scene::Scene> scene, const scene::Camera& camera,
                   const RigOptions& options)
    : parts_(engine(options.tracer).parts()),
      moving_(parts_.device, *parts_.tracer,
              engine(options.tracer).upload(std::move(scene), options.environment)),
      options_(options),
      settings_(options.settings),
      constants_buffers_(parts_.device),
      pool_(parts_.device, 3, 24),
      frame_set_(pool_.allocate(parts_.programs.frame_layout.handle())),
      half_frame_set_(pool_.allocate(parts_.programs.frame_layout.handle())),
      scene_set_(pool_.allocate(parts_.programs.scene_layout.handle())),
      inputs_{parts_.programs,
              moving_.resources(),
              moving_.tables(),
              *parts_.tracer,
              moving_.structure(),
              constants_,
              half_constants_,
              settings_,
              clock_,
              moving_,
              scene_motion_,
              all_buffers_,
              parts_.split_sum_table,
              parts_.sheen_table,
              parts_.ltc_table,
              options.shown.value_or(options.extent)},
      plan_(parts_.device, options.extent) {
  const auto& environment =
      moving_.resources().environment->view(settings_.environment.separate_sun);
  const gpu::Buffer& lights = moving_.tables().lights;
  render::write_frame_set(parts_, frame_set_, constants_buffers_.whole, lights, environment);
  render::write_frame_set(parts_, half_frame_set_, constants_buffers_.half, lights, environment);
  plan_.use_host_kernels(parts_.host_kernels);
  plan_.share_set(render::frame_set, frame_set_);
  plan_.share_set(render::frame_set, half_frame_set_, 2);
  render::write_scene_set(parts_.device, scene_set_, moving_.tables(),
                          moving_.resources().texture_heap, moving_.layers(), moving_.emissive());
  plan_.share_set(render::scene_set, scene_set_);
  set_view(camera);
}

void FrameRig::set_view(const scene::Camera& camera, std::uint32_t sample) {
  const shared::FrameConstants before = constants_;
  constants_ = render::make_frame_constants(camera, settings_, moving_,
                                            {.drawn = options_.extent, .shown = inputs_.shown},
                                            sample, has_view_ ? &before : nullptr);
  clock_.age = has_view_ ? clock_.age + 1 : 0;
  has_view_ = true;
  half_constants_ = render::at_half_size(constants_);
  constants_buffers_.upload(constants_, half_constants_);
}

void FrameRig::draw_smaller(VkExtent2D drawn, const scene::Camera& camera) {
  options_.extent = drawn;
  plan_.set_drawn(drawn);
  set_view(camera);
}

void FrameRig::run() {
  if (!compiled_) plan_.compile();
  compiled_ = true;
  plan_.execute();
}

render::FloatImage FrameRig::read(gpu::ImageRef image) const {
  return render::read_image(plan_.latest(image), plan_.drawn(image));
}

}  // namespace heliograph::test
