#include "gpu/device/queues.hpp"

#include <algorithm>
#include <array>
#include <optional>

namespace heliograph::gpu {
namespace {

/// 16 sessions on an H100 get 582 frames a second from four, 612 from six and 637 from eight, all
/// that it has; the slowest of them 32, 33 and 36.
constexpr std::uint32_t most_compute_queues = 8;
constexpr std::array<float, most_compute_queues> equal_priorities{1.0f, 1.0f, 1.0f, 1.0f,
                                                                  1.0f, 1.0f, 1.0f, 1.0f};

std::vector<VkQueueFamilyProperties> families_of(VkPhysicalDevice device) {
  std::uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
  return families;
}

/// The first with all `needed` flags and none of the `unwanted` ones.
std::optional<std::uint32_t> find_family(std::span<const VkQueueFamilyProperties> families,
                                         VkQueueFlags needed, VkQueueFlags unwanted) {
  for (std::uint32_t i = 0; i < families.size(); ++i) {
    const VkQueueFlags flags = families[i].queueFlags;
    const bool timed = families[i].timestampValidBits > 0;
    if ((flags & needed) == needed && (flags & unwanted) == 0 && timed) return i;
  }
  return std::nullopt;
}

std::optional<std::uint32_t> general_family(std::span<const VkQueueFamilyProperties> families) {
  return find_family(families, VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT, 0);
}

}  // namespace

bool has_general_queue(VkPhysicalDevice device) {
  return general_family(families_of(device)).has_value();
}

Queues::Queues(VkPhysicalDevice device, bool processor) {
  const auto families = families_of(device);
  const auto add = [this](std::uint32_t family, std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i) {
      queues_.push_back(std::make_unique<Queue>());
      queues_.back()->family = family;
    }
    families_.push_back(family);
    VkDeviceQueueCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    info.queueFamilyIndex = family;
    info.queueCount = count;
    info.pQueuePriorities = equal_priorities.data();
    infos_.push_back(info);
  };
  const auto everything = general_family(families);
  if (!everything) throw GpuError("the device has no graphics and compute queue");
  add(*everything, 1);
  if (processor) return;
  if (const auto compute = find_family(families, VK_QUEUE_COMPUTE_BIT, VK_QUEUE_GRAPHICS_BIT)) {
    add(*compute, std::min(families[*compute].queueCount, most_compute_queues));
  }
}

Queues::~Queues() {
  if (!device_) return;
  for (const auto& queue : queues_) vkDestroySemaphore(device_, queue->timeline, nullptr);
}

std::span<const VkDeviceQueueCreateInfo> Queues::create_infos() const {
  return infos_;
}

void Queues::open(VkDevice device) {
  device_ = device;
  VkSemaphoreTypeCreateInfo type{VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO};
  type.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
  const VkSemaphoreCreateInfo timeline{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, &type};
  std::uint32_t family = queues_.front()->family;
  std::uint32_t index = 0;  // within the family
  for (const auto& queue : queues_) {
    if (queue->family != family) index = 0;
    family = queue->family;
    vkGetDeviceQueue(device, family, index++, &queue->handle);
    check(vkCreateSemaphore(device, &timeline, nullptr, &queue->timeline), "create a semaphore");
  }
}

std::uint32_t Queues::family(std::uint32_t queue) const {
  return queues_.at(queue)->family;
}

std::span<const std::uint32_t> Queues::families() const {
  return families_;
}

std::size_t Queues::compute_count() const {
  return std::max<std::size_t>(queues_.size() - 1, 1);
}

std::uint64_t Queues::waiting_before(const Queue& queue) const {
  std::uint64_t done = 0;
  check(vkGetSemaphoreCounterValue(device_, queue.timeline, &done), "ask a queue what is done");
  return queue.submitted - std::min<std::uint64_t>(done, queue.submitted);
}

std::uint32_t Queues::idlest_compute() const {
  if (queues_.size() == 1) return general;
  std::uint32_t idlest = 1;
  std::uint64_t least = waiting_before(*queues_[idlest]);
  for (std::uint32_t i = idlest + 1; i < queues_.size() && least > 0; ++i) {
    const std::uint64_t waiting = waiting_before(*queues_[i]);
    if (waiting >= least) continue;
    least = waiting;
    idlest = i;
  }
  return idlest;
}

bool Queues::is_crowded() const {
  const auto working = std::count_if(queues_.begin() + 1, queues_.end(),
                                     [&](const auto& queue) { return waiting_before(*queue) > 0; });
  // A session alone has two frames on the device.
  return working > 2 && 2 * static_cast<std::size_t>(working) > compute_count();
}

Submission Queues::submit(VkCommandBuffer commands, std::uint32_t number,
                          const std::optional<Submission>& after) const {
  Queue& queue = *queues_.at(number);
  VkCommandBufferSubmitInfo buffer{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
  buffer.commandBuffer = commands;
  VkSemaphoreSubmitInfo done{VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO};
  done.semaphore = queue.timeline;
  done.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  VkSubmitInfo2 info{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
  info.commandBufferInfoCount = 1;
  info.pCommandBufferInfos = &buffer;
  info.signalSemaphoreInfoCount = 1;
  info.pSignalSemaphoreInfos = &done;
  VkSemaphoreSubmitInfo before{VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO};
  if (after) {
    before.semaphore = queues_.at(after->queue)->timeline;
    before.value = after->number;
    before.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    info.waitSemaphoreInfoCount = 1;
    info.pWaitSemaphoreInfos = &before;
  }
  const std::lock_guard lock(queue.mutex);
  done.value = queue.submitted + 1;
  check(vkQueueSubmit2(queue.handle, 1, &info, VK_NULL_HANDLE), "give commands to the device");
  ++submissions_;
  return {number, ++queue.submitted};
}

bool Queues::wait_for(const Submission& submission, std::chrono::nanoseconds time) const {
  VkSemaphoreWaitInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO};
  info.semaphoreCount = 1;
  info.pSemaphores = &queues_.at(submission.queue)->timeline;
  info.pValues = &submission.number;
  const auto most = static_cast<std::uint64_t>(std::max<std::int64_t>(time.count(), 0));
  const VkResult result = vkWaitSemaphores(device_, &info, most);
  if (result == VK_TIMEOUT) return false;
  check(result, "run commands on the device");
  return true;
}

}  // namespace heliograph::gpu
