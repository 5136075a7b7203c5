// Passes that run on the host, and host kernels in place of shaders.
#include <chrono>
#include <thread>

#include "tests/gpu/frame_plan/frame_plan_fixture.hpp"

namespace heliograph::gpu {
namespace {

/// Of add.comp.
template <class Stage>
struct AddBindings {
  Read<Stage> from;
  Write<Stage> to;
};
template <class Stage>
struct OtherBindings {
  Read<Stage> from;
  Write<Stage> to;
};
using AddPass = HostPass<AddBindings, float>;

void add_on_host(const AddPass& pass) {
  for (int y = 0; y < pass.height; ++y) {
    const auto row = static_cast<std::uint32_t>(y);
    for (int x = 0; x < pass.width; ++x) {
      pass.to.row<float>(row)[x] = pass.from.row<const float>(row)[x] + pass.constants;
    }
  }
}

TEST_F(FramePlanTest, HostPassesAloneSubmitNothing) {
  int runs = 0;
  plan_.host("first", [&] { ++runs; });
  plan_.host("second", [&] { ++runs; });
  plan_.compile();
  plan_.execute();
  EXPECT_EQ(runs, 2);
  EXPECT_EQ(plan_.submits(), 0u);
}

TEST_F(FramePlanTest, SubmitsOnlyWhereTheHostWaits) {
  if (device_.is_cpu()) GTEST_SKIP() << "passes are timed one by one on CPU devices";
  const auto a = image("a"), b = image("b"), c = image("c");
  add("first", a, b);
  add("second", b, c);
  plan_.host("host", [] {});
  plan_.compile();
  plan_.execute();
  EXPECT_EQ(plan_.submits(), 1u);
}

TEST_F(FramePlanTest, RunsHostPassesOnMappedImagesBetweenDevicePasses) {
  if (!device_.is_cpu()) GTEST_SKIP() << "images are mapped on CPU devices only";
  const auto a = image("a"), b = image("b"), c = image("c");
  const History history = plan_.history("history", format);
  plan_.host("first", [] {});
  add("before", a, b, 3.0f);
  add("count", history.previous, history.current);
  float counted = 0.0f;
  plan_.host("square", [&] {
    const HostView view = plan_.get(b).host();
    for (std::uint32_t y = 0; y < 9; ++y) {
      for (std::uint32_t x = 0; x < 13; ++x) view.row<float>(y)[x] *= view.row<float>(y)[x];
    }
    counted = plan_.get(history.current).host().row<float>(8)[12];
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  });
  add("after", b, c, 1.0f);
  plan_.host("last", [] {});
  plan_.compile();
  for (int frame = 1; frame <= 3; ++frame) {
    plan_.execute();
    EXPECT_EQ(value(c), 10.0f);
    EXPECT_EQ(counted, static_cast<float>(frame));
  }
  ASSERT_EQ(plan_.timings().size(), 6u);
  EXPECT_TRUE(plan_.timings()[3].host);
  EXPECT_EQ(plan_.timings()[3].name, "square");
  EXPECT_GE(plan_.timings()[3].milliseconds, 5.0f);
  EXPECT_FALSE(plan_.timings()[4].host);
  for (const PassTiming& timing : plan_.timings()) EXPECT_GE(timing.milliseconds, 0.0f);
}

TEST_F(FramePlanTest, BindingListFollowsTheShadersBindings) {
  const auto a = image("a"), b = image("b");
  plan_.pass("listed", program_)
      .bind<AddBindings>({.from = a, .to = b})
      .constants(2.0f)
      .dispatch(plan_.extent());
  plan_.compile();
  plan_.execute();
  EXPECT_EQ(value(b), 2.0f);
}

class HostKernels : public FramePlanTest {
 protected:
  void SetUp() override {
    if (!device_.is_cpu()) GTEST_SKIP() << "host kernels run on CPU devices only";
    plan_.use_host_kernels(true);
  }
  PassBuilder add_listed(const std::string& name, ImageRef from, ImageRef to) {
    PassBuilder pass = plan_.pass(name, [this]() -> const ComputeProgram& {
      ++programs_made_;
      return program_;
    });
    pass.bind<AddBindings>({.from = from, .to = to}).constants(2.0f).dispatch(plan_.extent());
    return pass;
  }
  int programs_made_ = 0;
};

TEST_F(HostKernels, ReplaceTheShaderWithoutMakingIt) {
  const auto a = image("a"), b = image("b"), c = image("c");
  add_listed("host", a, b).host(add_on_host);
  plan_.use_host_kernels(false);
  add_listed("shader", b, c).host(add_on_host);
  plan_.compile();
  plan_.execute();
  EXPECT_EQ(value(c), 4.0f);
  EXPECT_TRUE(plan_.timings()[0].host);
  EXPECT_FALSE(plan_.timings()[1].host);
  EXPECT_EQ(programs_made_, 1);
}

TEST_F(HostKernels, RunOnlyWhereTheyKnowTheCase) {
  const auto a = image("a"), b = image("b"), c = image("c"), d = image("d");
  bool known = true;
  add_listed("unknown", a, b).host(add_on_host).host_when(false);
  add_listed("by frame", b, c).host(add_on_host).host_when([&known] { return known; });
  add("last", c, d);
  plan_.compile();
  for (int frame = 0; frame < 4; ++frame) {
    known = frame % 2 == 0;
    plan_.execute();
    EXPECT_EQ(value(d), 5.0f);
    EXPECT_FALSE(plan_.timings()[0].host);
    EXPECT_EQ(plan_.timings()[1].host, known);
    EXPECT_GE(plan_.timings()[1].milliseconds, 0.0f);
  }
}

TEST_F(HostKernels, MustTakeTheListAndConstantsOfTheirPass) {
  const auto a = image("a"), b = image("b");
  plan_.pass("other list", program_)
      .bind<OtherBindings>({.from = a, .to = b})
      .constants(2.0f)
      .dispatch(plan_.extent())
      .host(add_on_host);
  expect_complaint({"other list", "another list of bindings"});
}

TEST_F(HostKernels, MustTakeTheSizeOfTheConstants) {
  const auto a = image("a"), b = image("b");
  plan_.pass("other constants", program_)
      .bind<AddBindings>({.from = a, .to = b})
      .constants(2.0)
      .dispatch(plan_.extent())
      .host(add_on_host);
  expect_complaint({"other constants", "takes 4 bytes", "given 8"});
}

}  // namespace
}  // namespace heliograph::gpu
