// What is declared of a pass.

#include <utility>

#include "gpu/frame_plan/frame_plan_parts.hpp"

namespace heliograph::gpu {

PassBuilder& PassBuilder::use(Use use) {
  plan_.passes_[pass_].bound.push_back(use);
  return *this;
}

PassBuilder& PassBuilder::use_list(const char* tag, std::span<const Use> uses) {
  FramePlan::Pass& pass = plan_.passes_[pass_];
  pass.list = tag;
  pass.listed.assign(uses.begin(), uses.end());
  for (const Use& listed : uses) {
    if (listed.resource != ImageRef().index) pass.bound.push_back(listed);
  }
  return *this;
}

PassBuilder& PassBuilder::set_host(const char* tag, std::size_t constants_size, HostRun run) {
  if (!plan_.host_kernels_) return *this;
  FramePlan::Pass& pass = plan_.passes_[pass_];
  pass.kernel = std::move(run);
  pass.kernel_list = tag;
  pass.kernel_constants_size = constants_size;
  return *this;
}

PassBuilder& PassBuilder::host_when(bool known) {
  if (!known) plan_.passes_[pass_].kernel = nullptr;
  return *this;
}

PassBuilder& PassBuilder::host_when(std::function<bool()> known) {
  plan_.passes_[pass_].kernel_known = std::move(known);
  return *this;
}

PassBuilder& PassBuilder::set_constants(std::size_t size, std::function<void(std::byte*)> fill) {
  plan_.passes_[pass_].constants_size = size;
  plan_.passes_[pass_].constants = std::move(fill);
  return *this;
}

PassBuilder& PassBuilder::color(ImageRef image, std::optional<std::array<float, 4>> clear) {
  plan_.passes_[pass_].colors.push_back({image.index, clear});
  return *this;
}

PassBuilder& PassBuilder::depth(ImageRef image, float clear) {
  plan_.passes_[pass_].depth = FramePlan::Pass::Attachment{image.index, {{clear, 0, 0, 0}}};
  return *this;
}

PassBuilder& PassBuilder::dispatch(FrameSize threads, std::uint32_t layers) {
  plan_.passes_[pass_].threads = threads.reduced(plan_.passes_[pass_].side);
  plan_.passes_[pass_].layers = layers;
  return *this;
}

PassBuilder& PassBuilder::dispatch_indirect(BufferRef groups, VkDeviceSize offset) {
  plan_.passes_[pass_].indirect.emplace(groups.index, offset);
  return *this;
}

PassBuilder& PassBuilder::launch(std::uint32_t rays) {
  plan_.passes_[pass_].threads = {rays, 1};
  return *this;
}

PassBuilder& PassBuilder::draw(std::function<void(VkCommandBuffer, VkPipelineLayout)> record) {
  plan_.passes_[pass_].draw = std::move(record);
  return *this;
}

PassBuilder& PassBuilder::when(std::function<bool()> condition) {
  if (!condition) return *this;
  plan_.passes_[pass_].condition = std::move(condition);
  plan_.passes_[pass_].conditions = {plan_.new_condition()};
  return *this;
}

PassBuilder& PassBuilder::in_a_crowd(const ComputeProgram& program) {
  plan_.passes_[pass_].in_a_crowd = &program;
  return *this;
}

}  // namespace heliograph::gpu
