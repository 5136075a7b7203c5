#include "gpu/frame_plan/frame_plan.hpp"

#include <algorithm>
#include <utility>

#include "gpu/frame_plan/frame_plan_parts.hpp"

namespace heliograph::gpu {
namespace {

/// Passes fetch texels of images, of integers too, which have no linear filter.
Sampler make_default_sampler(const Device& device) {
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  info.magFilter = info.minFilter = VK_FILTER_NEAREST;
  info.addressModeU = info.addressModeV = info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  return Sampler(device, info);
}

}  // namespace

FramePlan::FramePlan(const Device& device, VkExtent2D extent)
    : device_(device),
      extent_(extent),
      drawn_(extent),
      default_sampler_(make_default_sampler(device)) {}

FramePlan::~FramePlan() {
  try {
    for (const Begun& begun : begun_) {  // what they use is freed now
      if (begun.submitted) device_.wait(*begun.submitted);
    }
    wait();
  } catch (const std::runtime_error&) {
    // The device is lost: it uses nothing any more.
  }
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
  size = size.reduced(side_);
  const bool depth = is_depth(format);
  ImageDesc desc{.name = std::string(name), .extent = size.of(extent_), .format = format};
  desc.usage = extra_usage | VK_IMAGE_USAGE_SAMPLED_BIT |
               (depth ? VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT : VK_IMAGE_USAGE_STORAGE_BIT);
  desc.mapped = device_.is_cpu() && !depth;
  Resource resource{.name = std::string(name), .size = size, .image_desc = std::move(desc)};
  if (!makes_later_) make(resource, {});
  return {add(std::move(resource))};
}

History FramePlan::history(std::string_view name, VkFormat format, VkImageUsageFlags extra_usage,
                           FrameSize size) {
  size = size.reduced(side_);
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
  if (!makes_later_) make_history(current, {});
  return {{current}, {previous}};
}

BufferRef FramePlan::buffer(std::string name, VkDeviceSize size, VkBufferUsageFlags usage,
                            Memory memory) {
  Resource resource{.name = std::move(name), .buffer_desc = {{size, usage, memory}}};
  if (!makes_later_) make(resource, {});
  return {add(std::move(resource))};
}

BufferRef FramePlan::returned(std::string name, VkDeviceSize size, VkBufferUsageFlags usage) {
  Resource resource{.name = std::move(name)};
  for (std::size_t slot = 0; slot < 2; ++slot) {
    const bool own = slot == 0 || !device_.is_cpu();
    resource.owned_buffers[slot] =
        own ? std::make_shared<const Buffer>(device_, resource.name, size, usage, Memory::readback)
            : resource.owned_buffers[0];
    resource.buffers[slot] = resource.owned_buffers[slot].get();
  }
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

void FramePlan::share_set(std::uint32_t number, const std::array<VkDescriptorSet, 2>& sets,
                          std::uint32_t side) {
  shared_sets_.push_back({number, side, sets});
}

void FramePlan::reduced(std::uint32_t side, const std::function<void()>& declare) {
  const std::uint32_t before = std::exchange(side_, side_ * side);
  declare();
  side_ = before;
}

PassBuilder FramePlan::add(Pass pass) {
  pass.side = side_;
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
                          const std::function<void()>& declare,
                          const std::function<void()>& otherwise) {
  if (!condition) return declare();
  const std::size_t first = passes_.size();
  declare();
  const std::size_t second = passes_.size();
  if (otherwise) otherwise();
  const std::uint32_t number = new_condition();
  for (std::size_t i = first; i < passes_.size(); ++i) {
    const bool met = i < second;
    std::function<bool()>& own = passes_[i].condition;
    own = [condition, met, own] { return condition() == met && (!own || own()); };
    passes_[i].conditions.push_back(met ? number : opposite_condition(number));
  }
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
  make_programs();
  order_passes();
  device_.submit_once([this](VkCommandBuffer commands) {
    setup_ = commands;
    make_histories();
    make_in_blocks();
    make_resources();
  });
  setup_ = VK_NULL_HANDLE;
  for (const Pass& pass : passes_) check_pass(pass);
  list_views();
  make_descriptor_sets();
  make_command_buffers();
  VkQueryPoolCreateInfo queries{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
  queries.queryType = VK_QUERY_TYPE_TIMESTAMP;
  queries.queryCount = static_cast<std::uint32_t>(passes_.size() * 2 + 1);
  check(vkCreateQueryPool(device_.handle(), &queries, nullptr, &queries_), "create the timers");
  for (const Pass& pass : passes_) timings_.push_back({pass.name, pass.is_host_only(), 0.0f});
  measured_.assign(passes_.size(), -1.0f);
  if (read_back_.index != ImageRef().index) {
    for (Readback& readback : readbacks_) readback = Readback(device_, latest(read_back_));
  }
  compiled_ = true;
}

void FramePlan::make_programs() {
  for (Pass& pass : passes_) {
    if (pass.is_host_only()) {
      pass.program = nullptr;
    } else if (pass.make_program) {
      const ComputeProgram& program = pass.make_program();
      pass.program = &program;
      pass.local_size = program.local_size();
    }
  }
}

void FramePlan::make_command_buffers() {
  draws_ = std::ranges::any_of(passes_, &Pass::is_raster);
  VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  pool.queueFamilyIndex = device_.queues().family(choose_queue());
  pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
  check(vkCreateCommandPool(device_.handle(), &pool, nullptr, &command_pool_),
        "create a command pool");
  std::uint32_t submits = 4;
  for (const Pass& pass : passes_) {
    submits += timed_by_clock() || pass.is_host_only() ? 1 : 0;
  }
  commands_.resize(2 * std::size_t{submits});
  VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  info.commandPool = command_pool_;
  info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
  info.commandBufferCount = 2 * submits;
  check(vkAllocateCommandBuffers(device_.handle(), &info, commands_.data()),
        "allocate the frame's command buffers");
  if (timed_by_clock()) return;
  // A driver takes memory for commands when the first are recorded, which no frame waits for here.
  for (const VkCommandBuffer commands : commands_) {
    VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    check(vkBeginCommandBuffer(commands, &begin), "begin a command buffer");
    full_barrier(commands);
    check(vkEndCommandBuffer(commands), "end a command buffer");
  }
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
  return physical(image.index, slot_of_latest(resources_[image.index]));
}
const Buffer& FramePlan::get(BufferRef buffer) const {
  return *resources_[buffer.index].buffers[parity_];
}
const Buffer& FramePlan::latest(BufferRef buffer) const {
  return *resources_[buffer.index].buffers[slot_of_latest(resources_[buffer.index])];
}

std::uint32_t FramePlan::slot_of_latest(const Resource& resource) const {
  const auto& [even, odd] = resource.written;
  if (!resource.doubled || std::max(even, odd) == 0) return finished_;
  const bool newer_is_finished = std::max(even, odd) <= finished_frame_;
  return (even < odd) == (newer_is_finished || std::min(even, odd) == 0) ? 1 : 0;
}

std::vector<std::uint8_t> FramePlan::read() {
  const Readback& readback = readbacks_[finished_];
  if (!readback) return {};
  if (!std::exchange(came_back_, true) && readback.copies()) {
    device_.submit_once(
        [&](VkCommandBuffer commands) { readback.record(commands, latest(read_back_)); });
  }
  return readback.read<std::uint8_t>(latest(read_back_));
}

void FramePlan::reset(const History& history) {
  for (const Image* image : resources_[history.current.index].images) image->clear(setup_);
}

}  // namespace heliograph::gpu
