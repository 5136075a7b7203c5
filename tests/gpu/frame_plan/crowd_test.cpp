// What runs in frames that begin while the device works on many others.
#include <cstdint>
#include <memory>
#include <vector>

#include "tests/gpu/device/filling.hpp"
#include "tests/gpu/frame_plan/frame_plan_fixture.hpp"

namespace heliograph::gpu {
namespace {

/// Work on some of a device's queues for compute. It waits for the next submission to the general
/// queue, such as that of a download, at the latest for the end of this.
class Crowd {
 public:
  Crowd(const Device& device, std::uint32_t queues) : device_(device) {
    Submission gate = device.submit(gate_.commands, Queues::general);
    device.wait(gate);
    ++gate.number;  // of the next submission
    for (std::uint32_t queue = 1; queue <= queues; ++queue) {
      fillings_.push_back(std::make_unique<Filling>(device, queue, buffer_, queue));
      waiting_.push_back(device.submit(fillings_.back()->commands, queue, gate));
    }
  }
  ~Crowd() {
    device_.wait(device_.submit(gate_.commands, Queues::general));
    for (const Submission& submission : waiting_) device_.wait(submission);
  }

 private:
  const Device& device_;
  Buffer buffer_{device_, "filled", 64, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, Memory::device};
  Filling gate_{device_, Queues::general, buffer_, 0};
  std::vector<std::unique_ptr<Filling>> fillings_;
  std::vector<Submission> waiting_;
};

class CrowdTest : public FramePlanTest {
 protected:
  void SetUp() override {
    if (queues() < 4) GTEST_SKIP() << "the device has " << queues() << " queues for compute";
  }
  std::uint32_t queues() const {
    return static_cast<std::uint32_t>(device_.queues().compute_count());
  }
};

TEST_F(CrowdTest, IsWorkOnMostQueues) {
  EXPECT_FALSE(device_.queues().is_crowded());
  for (std::uint32_t working = 1; working <= queues(); ++working) {
    const Crowd crowd(device_, working);
    EXPECT_EQ(device_.queues().is_crowded(), working > 2 && 2 * working > queues()) << working;
  }
  EXPECT_FALSE(device_.queues().is_crowded());
}

TEST_F(CrowdTest, AnotherShaderRuns) {
  const ComputeProgram subtract(device_, test::shaders::subtract);
  const auto a = image("a"), b = image("b");
  add("change", a, b).in_a_crowd(subtract);
  plan_.keep(b);
  plan_.compile();
  plan_.execute();
  EXPECT_EQ(value(b), 1.0f);
  {
    const Crowd crowd(device_, queues() - 1);
    plan_.execute();
    EXPECT_EQ(value(b), -1.0f);
  }
  plan_.execute();
  EXPECT_EQ(value(b), 1.0f) << "the others are done";
}

TEST_F(FramePlanTest, ErrorNamesShaderForCrowdsWithOtherBindings) {
  const ComputeProgram other(device_, test::shaders::sample_image);
  add("brighten", image("a"), image("b")).in_a_crowd(other);
  expect_complaint({"\"brighten\"", "in a crowd", "other bindings", "set 1 binding 0"});
}

TEST_F(FramePlanTest, ErrorNamesShaderForCrowdsWithOtherWorkgroups) {
  const ComputeProgram other(device_, test::shaders::add_in_rows);
  add("brighten", image("a"), image("b")).in_a_crowd(other);
  expect_complaint({"\"brighten\"", "in a crowd", "workgroups", "the workgroup size"});
}

}  // namespace
}  // namespace heliograph::gpu
