#include "tests/support/frame_rig.hpp"

#include <cstring>

#include "render/debug_view.hpp"

namespace heliograph::test {

FrameRig::FrameRig(std::shared_ptr<const scene::Scene> scene, const scene::Camera& camera,
                   const RigOptions& options)
    : parts_(engine(options.tracer).parts()),
      scene_(engine(options.tracer).upload(std::move(scene), options.environment)),
      options_(options),
      settings_(options.settings),
      constants_buffer_(parts_.device, "frame constants", sizeof(shared::FrameConstants),
                        VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, gpu::Memory::upload),
      pool_(parts_.device, 1, 8),
      frame_set_(pool_.allocate(parts_.programs.frame_layout.handle())),
      inputs_{parts_.programs, *scene_, *parts_.tracer, constants_, settings_, samples_, seconds_},
      plan_(parts_.device, options.extent) {
  constexpr auto uniform = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
  gpu::DescriptorWriter(parts_.device, frame_set_)
      .buffer(0, uniform, constants_buffer_.handle())
      .buffer(1, uniform, scene_->light_block.handle())
      .sampled_image(2, scene_->environment.map.view(), parts_.around.handle())
      .sampled_image(3, scene_->environment.prefiltered.view(), parts_.clamped.handle())
      .sampled_image(4, parts_.split_sum_table.view(), parts_.clamped.handle())
      .apply();
  plan_.share_set(render::frame_set, frame_set_);
  set_view(camera);
}

void FrameRig::set_view(const scene::Camera& camera, std::uint32_t sample) {
  const shared::FrameConstants before = constants_;
  constants_ = render::make_frame_constants(camera, settings_, *scene_, options_.extent, sample,
                                            has_view_ ? &before : nullptr);
  has_view_ = true;
  std::memcpy(constants_buffer_.mapped(), &constants_, sizeof constants_);
}

void FrameRig::run() {
  if (!compiled_) plan_.compile();
  compiled_ = true;
  plan_.execute();
}

render::FloatImage FrameRig::read(gpu::ImageRef image) const {
  return render::read_image(plan_.latest(image));
}

}  // namespace heliograph::test
