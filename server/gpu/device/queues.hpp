#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "gpu/device/vulkan.hpp"

namespace heliograph::gpu {

/// Work that one of a device's queues was given.
struct Submission {
  std::uint32_t queue = 0;
  std::uint64_t number = 0;  // of the queue's submissions, from 1
};

/// The queues of one device: the first does everything. GPUs that have them get queues for compute
/// alone beside it, whose work runs at the same time as that of the others: most passes of a frame
/// leave a large GPU partly idle. Further queues of the first kind would take turns with it.
class Queues {
 public:
  static constexpr std::uint32_t general = 0;

  /// Chooses. `processor`: one queue is enough. @throws GpuError without a queue for everything
  Queues(VkPhysicalDevice device, bool processor);
  ~Queues();
  Queues(const Queues&) = delete;
  Queues& operator=(const Queues&) = delete;

  /// For the creation of the device; valid as long as this object.
  std::span<const VkDeviceQueueCreateInfo> create_infos() const;
  /// Takes them from the device. @throws GpuError
  void open(VkDevice device);

  std::uint32_t family(std::uint32_t queue) const;
  /// Of all queues, each once.
  std::span<const std::uint32_t> families() const;
  /// So many pieces of work for compute alone run at the same time.
  std::size_t compute_count() const;
  /// The queue for compute with the least work before it: the first if there is none for compute
  /// alone. Thread safe.
  std::uint32_t idlest_compute() const;
  /// Whether more than two of the queues for compute alone, and more than half of them, have work:
  /// never where there are fewer than three. Thread safe.
  bool is_crowded() const;

  /// Returns at once. The device begins when it is done with `after`, if that is given. Thread
  /// safe.
  /// @throws GpuError, DeviceLost
  Submission submit(VkCommandBuffer commands, std::uint32_t queue,
                    const std::optional<Submission>& after) const;
  /// Until this work, and all that its queue was given before, is done, or the time is over. Thread
  /// safe. @returns whether it is done
  bool wait_for(const Submission& submission, std::chrono::nanoseconds time) const;
  /// How often work was submitted so far. Thread safe.
  std::uint64_t submissions() const { return submissions_; }

 private:
  struct Queue {
    VkQueue handle = VK_NULL_HANDLE;
    std::uint32_t family = 0;
    VkSemaphore timeline = VK_NULL_HANDLE;     // counts what is done
    std::atomic<std::uint64_t> submitted = 0;  // written under `mutex`
    std::mutex mutex;
  };

  std::uint64_t waiting_before(const Queue& queue) const;

  VkDevice device_ = VK_NULL_HANDLE;
  std::vector<std::unique_ptr<Queue>> queues_;
  std::vector<std::uint32_t> families_;
  std::vector<VkDeviceQueueCreateInfo> infos_;
  mutable std::atomic<std::uint64_t> submissions_ = 0;
};

/// Whether the device has a queue that does everything and can be timed.
bool has_general_queue(VkPhysicalDevice device);

}  // namespace heliograph::gpu
