#include "render/frame/compiled_frame.hpp"

#include <array>
#include <stdexcept>

#include "render/frame/buffer_list.hpp"
#include "render/frame/frame_set.hpp"
#include "render/passes/post/present.hpp"
#include "render/resources/moving/moving_scene.hpp"
#include "render/resources/scene_set.hpp"
#include "render/views/view_colors.hpp"

namespace heliograph::render {

CompiledFrame::CompiledFrame(const Engine::Parts& parts, const FrameInputs& in,
                             const FrameConstantsSlots& constants_buffers, VkExtent2D extent,
                             bool keeps_buffers, const std::optional<JpegRequest>& jpeg)
    : inputs(in),
      background(in.moving.environment().background(in.settings.background)),
      pool(parts.device, 5, 48),
      plan(parts.device, extent) {
  plan.use_host_kernels(parts.host_kernels);
  plan.share_memory();
  share_sets(parts, constants_buffers);
  outputs = declare_frame(plan, inputs);
  if (parts.jpeg_tables && can_encode_jpeg(parts.device, extent)) {
    encoded = encode_jpeg(plan, parts.programs, parts.jpeg_tables, outputs.output, extent, jpeg);
  }
  plan.read_back(outputs.output, [&jpeg] { return !jpeg; });
  plan.keep(outputs.radiance);
  plan.keep(outputs.mean);
  plan.keep(outputs.mean_weight);
  plan.keep_images(keeps_buffers);
  plan.compile();
  list_buffers();
}

void CompiledFrame::share_sets(const Engine::Parts& parts,
                               const FrameConstantsSlots& constants_buffers) {
  const EnvironmentView environment =
      inputs.moving.environment().view(inputs.settings.environment.separate_sun);
  const gpu::Image& seen = background ? background->image : environment.background;
  const auto share = [&](const auto& constants_of, std::uint32_t side) {
    std::array<VkDescriptorSet, 2> sets{};
    for (std::size_t slot = 0; slot < sets.size(); ++slot) {
      sets[slot] = pool.allocate(parts.programs.frame_layout.handle());
      write_frame_set(parts, sets[slot], constants_of(constants_buffers[slot]),
                      inputs.tables.lights, {seen, environment.maps, environment.sun});
    }
    plan.share_set(frame_set, sets, side);
  };
  share(
      [](const FrameConstantsBuffers& buffers) -> auto& { return buffers.whole; }, 1);
  share(
      [](const FrameConstantsBuffers& buffers) -> auto& { return buffers.half; }, 2);
  const VkDescriptorSet tables = pool.allocate(parts.programs.scene_layout.handle());
  write_scene_set(parts.device, tables, inputs.tables, inputs.scene.texture_heap,
                  inputs.moving.layers(), inputs.moving.emissive());
  plan.share_set(scene_set, tables);
}

void CompiledFrame::list_buffers() {
  const auto list = [this](std::string_view name) {
    const View view = find_view(name);
    if (!view) throw std::logic_error("no pass describes the buffer " + std::string(name));
    std::string text(view.description());
    const std::string_view colors = legend(view.colors());
    if (!colors.empty()) text.append(" ").append(colors);
    buffers.push_back({std::string(name), text});
  };
  list(present_buffers.output.name);
  list(present_buffers.radiance.name);
  for (const auto& image : plan.views()) {
    if (image.name == present_buffers.output.name) continue;
    list(image.name);
    for (const std::string& aspect : aspect_names(*find_view(image.name).buffer)) list(aspect);
  }
}

std::optional<CompiledFrame::DrawnImage> CompiledFrame::find(std::string_view buffer) const {
  for (const auto& view : plan.views()) {
    if (view.name == buffer && plan.holds(view.image)) return latest(view.image);
  }
  return std::nullopt;
}

}  // namespace heliograph::render
