#include "gpu/frame_plan/frame_plan.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "gpu/frame_plan/frame_plan_parts.hpp"

namespace heliograph::gpu {
namespace {

Sampler make_default_sampler(const Device& device) {
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  info.magFilter = info.minFilter = VK_FILTER_LINEAR;
  info.addressModeU = info.addressModeV = info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  return Sampler(device, info);
}

using Clock = std::chrono::steady_clock;

float since(Clock::time_point start) {
  return std::chrono::duration<float, std::milli>(Clock::now() - start).count();
}

std::uint32_t groups(std::uint32_t threads, std::uint32_t local_size) {
  return (threads + local_size - 1) / local_size;
}

}  // namespace

FramePlan::FramePlan(const Device& device, VkExtent2D extent)
    : device_(device),
      extent_(extent),
      drawn_(extent),
      default_sampler_(make_default_sampler(device)) {
  VkCommandPoolCreateInfo info{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  info.queueFamilyIndex = device.queue_family();
  info.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
  check(vkCreateCommandPool(device.handle(), &info, nullptr, &command_pool_),
        "create a command pool");
}

FramePlan::~FramePlan() {
  vkDestroyQueryPool(device_.handle(), queries_, nullptr);
  vkDestroyCommandPool(device_.handle(), command_pool_, nullptr);
}

std::uint32_t FramePlan::add(Resource resource) {
  if (compiled_) throw GpuError("resource \"" + resource.name + "\" comes after compile()");
  resources_.push_back(std::move(resource));
  return static_cast<std::uint32_t>(resources_.size() - 1);
}

ImageRef FramePlan::image(std::string_view name, VkFormat format, VkImageUsageFlags extra_usage,
                          FrameSize size) {
  const bool depth = is_depth(format);
  ImageDesc desc{.name = std::string(name), .extent = size.of(extent_), .format = format};
  desc.usage = extra_usage | VK_IMAGE_USAGE_SAMPLED_BIT |
               (depth ? VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT : VK_IMAGE_USAGE_STORAGE_BIT);
  desc.mapped = device_.is_cpu() && !depth;
  Resource resource{.name = std::string(name), .size = size, .image_desc = std::move(desc)};
  if (!shares_memory_) make(resource, {});
  return {add(std::move(resource))};
}

History FramePlan::history(std::string_view name, VkFormat format, VkImageUsageFlags extra_usage,
                           FrameSize size) {
  ImageDesc desc{.name = std::string(name), .extent = size.of(extent_), .format = format};
  desc.usage = extra_usage | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT;
  desc.mapped = device_.is_cpu();
  const std::uint32_t current = add(Resource{.name = std::string(name),
                                             .part = Resource::Part::current,
                                             .size = size,
                                             .image_desc = desc});
  const std::uint32_t previous = add(Resource{.name = std::string(name) + ".previous",
                                              .part = Resource::Part::previous,
                                              .size = size,
                                              .image_desc = std::move(desc)});
  if (!shares_memory_) make_history(current, {});
  return {{current}, {previous}};
}

BufferRef FramePlan::buffer(std::string name, VkDeviceSize size, VkBufferUsageFlags usage,
                            Memory memory) {
  Resource resource{.name = std::move(name), .buffer_desc = {{size, usage, memory}}};
  if (!shares_memory_) make(resource, {});
  return {add(std::move(resource))};
}

BufferRef FramePlan::import(const Buffer& buffer) {
  Resource resource{.name = buffer.name()};
  resource.buffers = {&buffer, &buffer};
  return {add(std::move(resource))};
}

ImageRef FramePlan::import(const Image& image, std::optional<std::uint32_t> level,
                           VkSampler sampler) {
  Resource resource{.name = image.desc().name, .size = image.desc().extent};
  resource.images = {&image, &image};
  resource.level = level;
  resource.sampler = sampler;
  return {add(std::move(resource))};
}

void FramePlan::share_set(std::uint32_t number, VkDescriptorSet set) {
  shared_sets_.emplace_back(number, set);
}

PassBuilder FramePlan::add(Pass pass) {
  passes_.push_back(std::move(pass));
  return {*this, passes_.size() - 1};
}

PassBuilder FramePlan::pass(std::string name, const ComputeProgram& program) {
  Pass pass;
  pass.name = std::move(name);
  pass.program = &program;
  pass.local_size = program.local_size();
  return add(std::move(pass));
}

PassBuilder FramePlan::pass(std::string name, ProgramSource program) {
  Pass pass;
  pass.name = std::move(name);
  pass.make_program = std::move(program);
  return add(std::move(pass));
}

PassBuilder FramePlan::pass(std::string name, const RayProgram& program) {
  Pass pass;
  pass.name = std::move(name);
  pass.program = pass.rays = &program;
  return add(std::move(pass));
}

PassBuilder FramePlan::raster(std::string name, const RasterProgram& program) {
  Pass pass;
  pass.name = std::move(name);
  pass.program = &program;
  pass.is_raster = true;
  return add(std::move(pass));
}

void FramePlan::only_when(const std::function<bool()>& condition,
                          const std::function<void()>& declare) {
  const std::size_t first = passes_.size();
  declare();
  for (std::size_t i = first; i < passes_.size(); ++i) {
    std::function<bool()>& own = passes_[i].condition;
    own = [condition, own] { return condition() && (!own || own()); };
    passes_[i].conditions.push_back(conditions_);
  }
  ++conditions_;
}

PassBuilder FramePlan::host(std::string name, std::function<void()> run) {
  Pass pass;
  pass.name = std::move(name);
  pass.host = std::move(run);
  return add(std::move(pass));
}

void FramePlan::keep_images(bool keep) {
  if (std::exchange(keeps_images_, keep) == keep || !compiled_ || !shares_memory_) return;
  descriptor_pool_.reset();
  release_shared();
  make_resources();
  make_descriptor_sets();
}

void FramePlan::finish_frames_from_here() {
  cancelable_ = passes_.size();
}

bool FramePlan::holds(ImageRef image) const {
  if (keeps_images() || std::ranges::find(kept_, image.index) != kept_.end()) return true;
  const Resource& resource = resources_[image.index];
  return is_history(image) ? !leaves_out(image.index) : !resource.shares;
}

bool FramePlan::is_history(ImageRef image) const {
  return resources_[image.index].part != Resource::Part::none;
}

void FramePlan::compile() {
  make_histories();
  make_resources();
  for (Pass& pass : passes_) {
    if (pass.is_host_only()) {
      pass.program = nullptr;
    } else if (pass.make_program) {
      const ComputeProgram& program = pass.make_program();
      pass.program = &program;
      pass.local_size = program.local_size();
    }
    check_pass(pass);
  }
  derive_barriers();
  list_views();
  make_descriptor_sets();
  std::uint32_t submits = 1;
  for (const Pass& pass : passes_) {
    submits += timed_by_clock() || pass.is_host_only() ? 1 : 0;
  }
  commands_.resize(submits);
  VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  info.commandPool = command_pool_;
  info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
  info.commandBufferCount = submits;
  check(vkAllocateCommandBuffers(device_.handle(), &info, commands_.data()),
        "allocate the frame's command buffers");
  VkQueryPoolCreateInfo queries{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
  queries.queryType = VK_QUERY_TYPE_TIMESTAMP;
  queries.queryCount = static_cast<std::uint32_t>(passes_.size() * 2 + 1);
  check(vkCreateQueryPool(device_.handle(), &queries, nullptr, &queries_), "create the timers");
  for (const Pass& pass : passes_) timings_.push_back({pass.name, pass.is_host_only(), 0.0f});
  if (read_back_.index != ImageRef().index) readback_ = Readback(device_, latest(read_back_));
  compiled_ = true;
}

void FramePlan::make_descriptor_sets() {
  const auto passes = static_cast<std::uint32_t>(passes_.size());
  std::uint32_t bindings = 1;
  for (const Pass& pass : passes_) bindings += static_cast<std::uint32_t>(pass.bound.size());
  descriptor_pool_ = std::make_unique<DescriptorPool>(device_, 2 * passes + 1, 2 * bindings);
  for (Pass& pass : passes_) {
    if (!pass.program || pass.bound.empty()) continue;
    for (std::uint32_t parity = 0; parity < 2; ++parity) {
      pass.sets[parity] = descriptor_pool_->allocate(pass.program->pass_set_layout());
      DescriptorWriter writer(device_, pass.sets[parity]);
      for (std::size_t i = 0; i < pass.bound.size(); ++i) {
        const ShaderBinding& binding = pass.program->pass_bindings()[i];
        const std::uint32_t index = pass.bound[i].resource;
        const Resource& resource = resources_[index];
        if (binding.type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE) {
          writer.storage_image(binding.binding, physical_view(index, parity));
        } else if (binding.type == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER) {
          writer.sampled_image(binding.binding, physical(index, parity).view(),
                               resource.sampler ? resource.sampler : default_sampler_.handle());
        } else if (binding.type == VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER) {
          writer.texel_buffer(binding.binding,
                              resource.buffers[parity]->texel_view(binding.format));
        } else {
          writer.buffer(binding.binding, binding.type, resource.buffers[parity]->handle());
        }
      }
      writer.apply();
    }
  }
}

bool FramePlan::timed_by_clock() const {
  return device_.is_cpu();
}

bool FramePlan::execute(const std::function<bool()>& canceled) {
  if (!compiled_) throw GpuError("a frame plan runs only after compile()");
  device_.check_presence();
  if (!timed_by_clock()) {
    vkResetQueryPool(device_.handle(), queries_, 0, static_cast<std::uint32_t>(passes_.size() * 2));
  }
  submits_ = 0;
  recording_ = false;
  bool barrier = false;  // of passes left out: those behind them rely on it
  for (std::size_t i = 0; i < passes_.size(); ++i) {
    const Pass& pass = passes_[i];
    timings_[i].milliseconds = -1.0f;  // not run
    // Where passes are timed by the clock, nothing is recorded that was not submitted.
    if (i < cancelable_ && canceled && timed_by_clock() && canceled()) return false;
    barrier |= pass.barrier_before;
    if (pass.condition && !pass.condition()) {
      barrier |= !pass.program;
      continue;
    }
    const bool on_host = pass.runs_on_host();
    timings_[i].host = on_host;
    const auto start = Clock::now();
    if (!on_host) {
      if (std::exchange(barrier, false)) full_barrier(recorder());
      record(pass, recorder(), static_cast<std::uint32_t>(i * 2));
      if (!timed_by_clock()) continue;
    }
    flush();
    if (!on_host) {
      timings_[i].milliseconds = since(start);
      continue;
    }
    const auto begun = Clock::now();
    if (pass.kernel) {
      run_host_kernel(pass);
    } else {
      pass.host();
    }
    timings_[i].milliseconds = since(begun);
  }
  if (readback_.copies()) readback_.record(recorder(), get(read_back_));
  flush();
  if (!timed_by_clock()) read_timers();
  parity_ ^= 1;
  return true;
}

void FramePlan::run_host_kernel(const Pass& pass) const {
  std::array<HostView, most_bindings> views{};
  for (std::size_t i = 0; i < pass.listed.size(); ++i) {
    const std::uint32_t index = pass.listed[i].resource;
    if (index == ImageRef().index) continue;
    const Resource& resource = resources_[index];
    const Buffer* const buffer = resource.buffers[parity_];
    views[i] =
        buffer ? HostView{buffer->mapped(), buffer->size()} : resource.images[parity_]->host();
  }
  std::array<std::byte, most_constants> constants;
  if (pass.constants) pass.constants(constants.data());
  pass.kernel(std::span(views).first(pass.listed.size()),
              std::span(constants).first(pass.constants_size), drawn_);
}

VkCommandBuffer FramePlan::recorder() {
  const VkCommandBuffer commands = commands_[submits_];
  if (std::exchange(recording_, true)) return commands;
  VkCommandBufferBeginInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  check(vkBeginCommandBuffer(commands, &info), "begin the frame's commands");
  return commands;
}

void FramePlan::flush() {
  if (!std::exchange(recording_, false)) return;
  const VkCommandBuffer commands = commands_[submits_++];
  // Mapped memory is read after this submit, by a host pass or by the caller that takes the frame.
  VkMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
  barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
  barrier.dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT;
  barrier.dstAccessMask = VK_ACCESS_2_HOST_READ_BIT | VK_ACCESS_2_HOST_WRITE_BIT;
  VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  dependency.memoryBarrierCount = 1;
  dependency.pMemoryBarriers = &barrier;
  vkCmdPipelineBarrier2(commands, &dependency);
  check(vkEndCommandBuffer(commands), "end the frame's commands");
  device_.submit(commands);
}

void FramePlan::record(const Pass& pass, VkCommandBuffer commands, std::uint32_t query) {
  if (device_.labels()) {
    VkDebugUtilsLabelEXT label{VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT};
    label.pLabelName = pass.name.c_str();
    vkCmdBeginDebugUtilsLabelEXT(commands, &label);
  }
  if (!timed_by_clock()) {
    vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, queries_, query);
  }
  if (pass.is_raster) {
    record_raster(pass, commands);
  } else {
    bind(pass, commands);
    const VkExtent2D threads = pass.threads.of(drawn_);
    if (pass.rays) {
      pass.rays->launch(commands, threads.width);
    } else if (pass.indirect) {
      vkCmdDispatchIndirect(commands, get(BufferRef{pass.indirect->first}).handle(),
                            pass.indirect->second);
    } else {
      vkCmdDispatch(commands, groups(threads.width, pass.local_size.width),
                    groups(threads.height, pass.local_size.height), pass.layers);
    }
  }
  if (!timed_by_clock()) {
    vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, queries_, query + 1);
  }
  if (device_.labels()) vkCmdEndDebugUtilsLabelEXT(commands);
}

void FramePlan::bind(const Pass& pass, VkCommandBuffer commands) {
  const VkPipelineBindPoint point = pass.bind_point();
  const VkPipelineLayout layout = pass.program->layout();
  vkCmdBindPipeline(commands, point, pass.program->pipeline());
  for (const auto& [number, set] : shared_sets_) {
    if (!pass.program->uses_set(number)) continue;
    vkCmdBindDescriptorSets(commands, point, layout, number, 1, &set, 0, nullptr);
  }
  if (pass.sets[parity_]) {
    vkCmdBindDescriptorSets(commands, point, layout, pass_set, 1, &pass.sets[parity_], 0, nullptr);
  }
  if (pass.constants) {
    std::array<std::byte, most_constants> bytes;
    pass.constants(bytes.data());
    vkCmdPushConstants(commands, layout, pass.program->stages(), 0,
                       static_cast<std::uint32_t>(pass.constants_size), bytes.data());
  }
}

void FramePlan::record_raster(const Pass& pass, VkCommandBuffer commands) {
  const auto attachment = [&](const Pass::Attachment& from) {
    VkRenderingAttachmentInfo info{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    info.imageView = physical(from.resource, parity_).view();
    info.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
    info.loadOp = from.clear ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD;
    info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    if (from.clear) std::memcpy(&info.clearValue, from.clear->data(), sizeof(float) * 4);
    return info;
  };
  std::vector<VkRenderingAttachmentInfo> colors;
  for (const auto& color : pass.colors) colors.push_back(attachment(color));
  VkRenderingAttachmentInfo depth{};
  if (pass.depth) depth = attachment(*pass.depth);
  VkRenderingInfo info{VK_STRUCTURE_TYPE_RENDERING_INFO};
  info.renderArea = {{0, 0}, drawn_};
  info.layerCount = 1;
  info.colorAttachmentCount = static_cast<std::uint32_t>(colors.size());
  info.pColorAttachments = colors.data();
  info.pDepthAttachment = pass.depth ? &depth : nullptr;
  vkCmdBeginRendering(commands, &info);
  const VkViewport viewport{
      0.0f, 0.0f, static_cast<float>(drawn_.width), static_cast<float>(drawn_.height), 0.0f, 1.0f};
  vkCmdSetViewport(commands, 0, 1, &viewport);
  vkCmdSetScissor(commands, 0, 1, &info.renderArea);
  bind(pass, commands);
  pass.draw(commands, pass.program->layout());
  vkCmdEndRendering(commands);
}

void FramePlan::read_timers() {
  const float period = device_.limits().timestampPeriod * 1e-6f;
  for (std::size_t i = 0; i < passes_.size(); ++i) {
    if (!passes_[i].program) continue;
    std::array<std::uint64_t, 2> times{};
    const VkResult result = vkGetQueryPoolResults(
        device_.handle(), queries_, static_cast<std::uint32_t>(i * 2), 2, sizeof times,
        times.data(), sizeof(std::uint64_t), VK_QUERY_RESULT_64_BIT);
    if (result == VK_SUCCESS) {
      timings_[i].milliseconds = static_cast<float>(times[1] - times[0]) * period;
    }
  }
}

const Image& FramePlan::physical(std::uint32_t index, std::uint32_t parity) const {
  return *resources_[index].images[parity];
}

VkImageView FramePlan::physical_view(std::uint32_t index, std::uint32_t parity) const {
  return physical(index, parity).level_view(resources_[index].level.value_or(0));
}

const Image& FramePlan::get(ImageRef image) const {
  return physical(image.index, parity_);
}
const Image& FramePlan::latest(ImageRef image) const {
  return physical(image.index, parity_ ^ 1);
}
const Buffer& FramePlan::get(BufferRef buffer) const {
  return *resources_[buffer.index].buffers[parity_];
}

std::vector<std::uint8_t> FramePlan::read() const {
  if (!readback_) return {};
  return readback_.read<std::uint8_t>(latest(read_back_));
}

void FramePlan::reset(const History& history) {
  for (const Image* image : resources_[history.current.index].images) image->clear();
}

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
  plan_.passes_[pass_].threads = threads;
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
  plan_.passes_[pass_].condition = std::move(condition);
  plan_.passes_[pass_].conditions = {plan_.conditions_++};
  return *this;
}

}  // namespace heliograph::gpu
