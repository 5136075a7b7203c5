#include "render/frame/compiled_frame.hpp"

#include "render/frame/frame_set.hpp"
#include "render/resources/moving_scene.hpp"
#include "render/resources/scene_set.hpp"
#include "render/views/view_table.hpp"

namespace heliograph::render {

Drawing::Drawing(const Engine::Parts& parts, const FrameInputs& in,
                 const gpu::Buffer& constants_buffer, VkExtent2D extent)
    : inputs(in), pool(parts.device, 2, 16), plan(parts.device, extent) {
  share_sets(parts, constants_buffer);
  outputs = declare_frame(plan, inputs);
  plan.read_back(outputs.picture);
  plan.compile();
  list_buffers();
}

void Drawing::share_sets(const Engine::Parts& parts, const gpu::Buffer& constants_buffer) {
  const VkDescriptorSet set = pool.allocate(parts.programs.frame_layout.handle());
  write_frame_set(parts, set, constants_buffer, inputs.tables.lights,
                  inputs.moving.environment().view(inputs.settings.environment.separate_sun));
  plan.share_set(frame_set, set);
  const VkDescriptorSet tables = pool.allocate(parts.programs.scene_layout.handle());
  write_scene_set(parts.device, tables, inputs.tables, inputs.scene.texture_heap,
                  inputs.scene.layers);
  plan.share_set(scene_set, tables);
}

void Drawing::list_buffers() {
  const auto list = [this](const std::string& view, const std::string& by_pass) {
    const std::string_view known = description_of(view), colors = legend(colors_of(view));
    std::string text = known.empty() ? by_pass : std::string(known);
    if (!colors.empty()) text.append(" ").append(colors);
    buffers.push_back({view, text});
  };
  buffers.push_back({std::string(picture_name), "The finished picture."});
  list(std::string(radiance_name), "What it shows before exposure and tone mapping: linear.");
  for (const auto& view : plan.views()) {
    if (view.name == picture_name) continue;
    list(view.name, view.description);
    for (const std::string& aspect : aspects_of(view.name)) list(aspect, {});
  }
}

const gpu::Image* Drawing::find(std::string_view buffer) const {
  for (const auto& view : plan.views()) {
    if (view.name == buffer) return &plan.latest(view.image);
  }
  return nullptr;
}

}  // namespace heliograph::render
