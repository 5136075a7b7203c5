// What a device is given runs on the queue that was named, beside the work of the others.
#include <gtest/gtest.h>

#include <set>

#include "gpu/device/device.hpp"
#include "gpu/memory/buffer.hpp"
#include "tests/gpu/device/filling.hpp"
#include "tests/support/engine.hpp"

namespace heliograph::gpu {
namespace {

TEST(Queues, EachCountsItsOwnSubmissions) {
  const Device& device = test::device();
  const Queues& queues = device.queues();
  const std::uint64_t before = queues.submissions();
  const bool has_compute = queues.families().size() > 1;
  const std::size_t count = has_compute ? queues.compute_count() + 1 : 1;
  for (std::uint32_t queue = 0; queue < count; ++queue) {
    const Buffer buffer(device, "filled", 64, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, Memory::readback);
    const Filling filling(device, queue, buffer, 7 + queue);
    const Submission first = device.submit(filling.commands, queue);
    device.wait(first);
    const Submission second = device.submit(filling.commands, queue);
    EXPECT_EQ(second.queue, queue);
    EXPECT_EQ(second.number, first.number + 1);
    device.wait(second);
    EXPECT_TRUE(queues.wait_for(first, std::chrono::nanoseconds(0))) << "older than the second";
    EXPECT_EQ(*reinterpret_cast<const std::uint32_t*>(buffer.mapped()), 7 + queue);
  }
  EXPECT_EQ(queues.submissions(), before + 2 * count);
}

TEST(Queues, ProcessorsHaveOneForEverything) {
  const Device& device = test::device();
  if (!device.is_cpu()) GTEST_SKIP() << "the device is no processor";
  EXPECT_EQ(device.queues().compute_count(), 1u);
  EXPECT_EQ(device.queues().idlest_compute(), Queues::general);
  EXPECT_EQ(device.queues().families().size(), 1u);
  EXPECT_FALSE(device.queues().is_crowded());
}

TEST(Queues, ComputeGoesToOneWithoutWork) {
  const Device& device = test::device();
  const Queues& queues = device.queues();
  if (queues.families().size() < 2) GTEST_SKIP() << "the device has no queue for compute alone";
  const Buffer buffer(device, "filled", 256u << 20, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                      Memory::device);
  std::set<std::uint32_t> used;
  std::vector<std::unique_ptr<Filling>> fillings;
  std::vector<Submission> submissions;
  for (std::uint32_t i = 0; i < queues.compute_count(); ++i) {
    fillings.push_back(std::make_unique<Filling>(device, 1, buffer, i));
  }
  for (const auto& filling : fillings) {
    const std::uint32_t queue = queues.idlest_compute();
    EXPECT_NE(queue, Queues::general);
    used.insert(queue);
    submissions.push_back(device.submit(filling->commands, queue));
  }
  for (const Submission& submission : submissions) device.wait(submission);
  EXPECT_EQ(used.size() > 1, queues.compute_count() > 1) << "one was still at work";
  EXPECT_EQ(queues.idlest_compute(), 1u) << "all are idle again: the first will do";
}

}  // namespace
}  // namespace heliograph::gpu
