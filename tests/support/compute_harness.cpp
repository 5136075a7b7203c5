#include "tests/support/compute_harness.hpp"

#include <cstring>

namespace heliograph::test {
namespace {

struct Constants {
  std::uint32_t count;
  std::uint32_t function;
};

gpu::SharedLayouts layouts(const FrameRig* rig) {
  if (!rig) return {};
  const render::Programs& programs = engine().parts().programs;
  return {{render::frame_set, &programs.frame_layout}, {render::scene_set, &programs.scene_layout}};
}

}  // namespace

ShaderFunctions::ShaderFunctions(const gpu::ShaderBinary& shader, const FrameRig* rig)
    : rig_(rig), program_(device(), shader, layouts(rig)) {}

std::vector<ShaderOutput> ShaderFunctions::call(std::uint32_t function,
                                                std::span<const ShaderInput> inputs) const {
  constexpr VkBufferUsageFlags storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  const auto count = static_cast<std::uint32_t>(inputs.size());
  gpu::FramePlan plan(device(), {1, 1});
  if (rig_) plan.share_set(render::frame_set, rig_->frame_set());
  if (rig_) plan.share_set(render::scene_set, rig_->scene_set());
  const auto given = plan.buffer("inputs", inputs.size_bytes(), storage, gpu::Memory::upload);
  const auto returned =
      plan.buffer("outputs", count * sizeof(ShaderOutput), storage, gpu::Memory::readback);
  plan.pass("functions", program_)
      .read(given)
      .write(returned)
      .constants(Constants{count, function})
      .dispatch({count, 1});
  plan.compile();
  std::memcpy(plan.get(given).mapped(), inputs.data(), inputs.size_bytes());
  plan.execute();
  std::vector<ShaderOutput> outputs(count);
  std::memcpy(outputs.data(), plan.get(returned).mapped(), count * sizeof(ShaderOutput));
  return outputs;
}

}  // namespace heliograph::test
