#include "gpu/frame_plan/frame_plan.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "tests/gpu/embedded.hpp"
#include "tests/support/engine.hpp"

namespace heliograph::gpu {
namespace {

constexpr VkFormat format = VK_FORMAT_R32_SFLOAT;

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

class FramePlanTest : public testing::Test {
 protected:
  /// One pass `name`: to = from + amount.
  PassBuilder add(const std::string& name, ImageRef from, ImageRef to, float amount = 1.0f) {
    return plan_.pass(name, program_)
        .read(from)
        .write(to)
        .constants(amount)
        .dispatch(plan_.extent());
  }
  ImageRef image(const std::string& name) {
    const ImageRef made = plan_.image(name, format);
    plan_.get(made).clear();
    return made;
  }
  float value(ImageRef image) {
    const auto bytes = plan_.latest(image).download();
    const auto* texels = reinterpret_cast<const float*>(bytes.data());
    for (std::size_t i = 1; i < bytes.size() / 4; ++i) EXPECT_EQ(texels[i], texels[0]) << i;
    return texels[0];
  }
  /// The error of compile().
  std::string complaint() {
    try {
      plan_.compile();
    } catch (const GpuError& error) {
      return error.what();
    }
    return {};
  }
  void expect_complaint(std::initializer_list<const char*> parts) {
    const std::string text = complaint();
    for (const char* part : parts)
      EXPECT_NE(text.find(part), std::string::npos) << part << ": " << text;
  }

  const Device& device_ = test::device();
  ComputeProgram program_{device_, test::shaders::add};
  FramePlan plan_{device_, {13, 9}};
};

TEST_F(FramePlanTest, RunsPassesInOrder) {
  const auto a = image("a"), b = image("b"), c = image("c");
  add("first", a, b, 2.0f);
  add("second", b, c, 3.0f);
  plan_.compile();
  plan_.execute();
  EXPECT_EQ(value(c), 5.0f);
}

TEST_F(FramePlanTest, EvaluatesConstantsEveryFrame) {
  const auto a = image("a"), b = image("b");
  float amount = 1.0f;
  plan_.pass("add", program_).read(a).write(b).constants([&] { return amount; }).dispatch({13, 9});
  plan_.compile();
  plan_.execute();
  EXPECT_EQ(value(b), 1.0f);
  amount = 4.0f;
  plan_.execute();
  EXPECT_EQ(value(b), 4.0f);
}

TEST_F(FramePlanTest, BarrierBetweenWriteAndRead) {
  const auto a = image("a"), b = image("b"), c = image("c");
  add("writes b", a, b);
  add("reads b", b, c);
  plan_.compile();
  EXPECT_EQ(plan_.barriers(), (std::vector<std::string>{"reads b"}));
}

TEST_F(FramePlanTest, BarrierBeforeWriteAfterReadOrWrite) {
  const auto a = image("a"), b = image("b"), c = image("c");
  add("reads a", a, b);
  add("writes a", c, a);
  add("writes a again", c, a);
  plan_.compile();
  EXPECT_EQ(plan_.barriers(), (std::vector<std::string>{"writes a", "writes a again"}));
}

TEST_F(FramePlanTest, NoBarrierBetweenIndependentPasses) {
  const auto a = image("a"), b = image("b"), c = image("c"), d = image("d");
  add("a to b", a, b);
  add("a to c", a, c);
  add("b to d", b, d);
  plan_.compile();
  EXPECT_EQ(plan_.barriers(), (std::vector<std::string>{"b to d"}));
}

TEST_F(FramePlanTest, NoBarrierAfterHostPass) {
  const auto a = image("a"), b = image("b"), c = image("c");
  add("device", a, b);
  plan_.host("host", [] {});
  add("device after", b, c);
  plan_.compile();
  EXPECT_TRUE(plan_.barriers().empty());
}

TEST_F(FramePlanTest, HistoriesSwapEveryFrameAndReset) {
  const History history = plan_.history("count", format);
  add("count", history.previous, history.current);
  plan_.compile();
  for (int frame = 1; frame <= 5; ++frame) {
    plan_.execute();
    EXPECT_EQ(value(history.current), static_cast<float>(frame));
  }
  plan_.reset(history);
  plan_.execute();
  EXPECT_EQ(value(history.current), 1.0f);
}

TEST_F(FramePlanTest, HistoriesKeepTheirContentWhenTheDrawnSizeChanges) {
  const History history = plan_.history("texels", format);
  add("texels", history.previous, history.current, 0.0f);
  plan_.compile();
  const VkExtent2D full = plan_.extent();
  std::vector<float> texels(std::size_t{full.width} * full.height);
  for (std::size_t i = 0; i < texels.size(); ++i) texels[i] = static_cast<float>(i);
  plan_.latest(history.current).upload(std::as_bytes(std::span(texels)));

  VkExtent2D before = full;
  // No texel of one size lies in the middle between two of the other.
  for (const VkExtent2D drawn : {VkExtent2D{11, 5}, full, {1, 1}}) {
    std::vector<float> expected = texels;
    for (std::uint32_t y = 0; y < drawn.height; ++y) {
      for (std::uint32_t x = 0; x < drawn.width; ++x) {
        const auto column = static_cast<std::uint32_t>((x + 0.5) / drawn.width * before.width);
        const auto row = static_cast<std::uint32_t>((y + 0.5) / drawn.height * before.height);
        expected[y * full.width + x] = texels[row * full.width + column];
      }
    }
    plan_.set_drawn(drawn);
    plan_.execute();
    const auto bytes = plan_.latest(history.current).download();
    std::memcpy(texels.data(), bytes.data(), bytes.size());
    for (std::uint32_t y = 0; y < drawn.height; ++y) {
      for (std::uint32_t x = 0; x < drawn.width; ++x) {
        EXPECT_EQ(texels[y * full.width + x], expected[y * full.width + x]) << x << ", " << y;
      }
    }
    before = drawn;
  }
}

TEST_F(FramePlanTest, CanceledFrameDoesNotSwapHistories) {
  if (!device_.is_cpu()) GTEST_SKIP() << "frames are canceled on CPU devices only";
  const auto a = image("a"), b = image("b");
  const History history = plan_.history("count", format);
  add("count", history.previous, history.current);
  add("behind", a, b);
  plan_.compile();
  EXPECT_TRUE(plan_.execute());
  for (const int passes : {0, 1}) {
    int asked = 0;
    EXPECT_FALSE(plan_.execute([&] { return asked++ == passes; }));
    EXPECT_EQ(asked, passes + 1) << "no pass runs after the one that was refused";
  }
  EXPECT_TRUE(plan_.execute([] { return false; }));
  EXPECT_EQ(value(history.current), 2.0f);
}

TEST_F(FramePlanTest, PassesSeeThatTheirFrameIsCanceled) {
  if (!device_.is_cpu()) GTEST_SKIP() << "frames are canceled on CPU devices only";
  int asked = 0, seen = 0;
  bool behind = false;
  plan_.host("long", [&] {
    for (int i = 0; i < 10; ++i) seen += plan_.is_canceled();
  });
  plan_.host("behind", [&] { behind = true; });
  plan_.finish_frames_from_here();
  plan_.host("last", [&] { EXPECT_FALSE(plan_.is_canceled()) << "too late"; });
  plan_.compile();
  EXPECT_FALSE(plan_.execute([&] { return asked++ == 4; })) << "also if it is true only once";
  EXPECT_EQ(asked, 5) << "once before the pass, then in it until it was true";
  EXPECT_EQ(seen, 7);
  EXPECT_FALSE(behind);
  asked = 0;
  EXPECT_TRUE(plan_.execute([&] { return asked++ > 11; })) << "asked 12 times before the end";
  EXPECT_TRUE(behind);
  EXPECT_FALSE(plan_.is_canceled());
  EXPECT_TRUE(plan_.execute());
}

// As renderers of two sessions do.
TEST_F(FramePlanTest, OneFrameBeginsWhileTheDeviceWorksOnAnother) {
  const auto a = image("a"), b = image("b");
  add("add", a, b, 2.0f);
  plan_.read_back(b);
  plan_.compile();
  FramePlan other(device_, {5, 3});
  const History count = other.history("count", format);
  other.pass("count", program_)
      .read(count.previous)
      .write(count.current)
      .constants(1.0f)
      .dispatch(other.extent());
  other.compile();
  for (int frame = 1; frame <= 3; ++frame) {
    EXPECT_TRUE(plan_.begin());
    EXPECT_TRUE(other.begin());
    EXPECT_EQ(plan_.in_flight(), !device_.is_cpu());
    plan_.finish();
    EXPECT_FALSE(plan_.in_flight());
    other.finish();
    EXPECT_EQ(value(b), 2.0f);
    const auto bytes = other.latest(count.current).download();
    EXPECT_EQ(*reinterpret_cast<const float*>(bytes.data()), float(frame));
  }
}

TEST_F(FramePlanTest, MayEndWhileTheDeviceWorksOnItsFrame) {
  const auto a = image("a"), b = image("b");
  add("add", a, b);
  plan_.compile();
  {
    FramePlan other(device_, {512, 512});
    const auto from = other.image("from", format), to = other.image("to", format);
    other.pass("add", program_).read(from).write(to).constants(1.0f).dispatch(other.extent());
    other.compile();
    EXPECT_TRUE(other.begin());
  }
  plan_.execute();
  EXPECT_EQ(value(b), 1.0f);
}

TEST_F(FramePlanTest, FramesBeginAndFinishInTurn) {
  const auto a = image("a"), b = image("b");
  add("add", a, b);
  plan_.compile();
  EXPECT_THROW(plan_.finish(), GpuError);
  plan_.begin();
  if (!device_.is_cpu()) plan_.begin();
  EXPECT_THROW(plan_.begin(), GpuError);
  plan_.finish();
}

TEST_F(FramePlanTest, TheNextFrameBeginsWhileTheDeviceWorksOnOne) {
  if (device_.is_cpu()) GTEST_SKIP() << "processors have finished a frame when it has begun";
  const History history = plan_.history("count", format);
  add("count", history.previous, history.current);
  plan_.read_back(history.current);
  plan_.compile();
  plan_.execute();  // with timers
  const auto count = [&] {
    float value = 0.0f;
    std::memcpy(&value, plan_.read().data(), sizeof value);
    return value;
  };
  plan_.begin();
  for (int frame = 2; frame <= 9; ++frame) {
    ASSERT_TRUE(plan_.can_begin_another());
    plan_.begin();
    EXPECT_FALSE(plan_.can_begin_another()) << "two are enough";
    plan_.finish();
    EXPECT_EQ(count(), static_cast<float>(frame));
  }
  plan_.finish();
  EXPECT_EQ(count(), 10.0f);
}

TEST_F(FramePlanTest, FramesWithTimersAreNotOverlapped) {
  if (device_.is_cpu()) GTEST_SKIP() << "processors have finished a frame when it has begun";
  const auto a = image("a"), b = image("b");
  bool wanted = false;
  add("maybe", a, b).when([&] { return wanted; });
  add("always", a, image("c"));
  plan_.compile();
  plan_.execute();
  EXPECT_LT(plan_.timings()[0].milliseconds, 0.0f);
  int overlapped = 0;
  for (int frame = 0; frame < 40; ++frame) {
    plan_.begin();
    overlapped += plan_.can_begin_another();
    plan_.finish();
  }
  EXPECT_GE(overlapped, 36);
  EXPECT_LT(overlapped, 40) << "one of sixteen is timed";
  wanted = true;
  plan_.execute();
  const float measured = plan_.timings()[0].milliseconds;
  EXPECT_GT(measured, 0.0f);
  wanted = false;
  plan_.execute();
  EXPECT_LT(plan_.timings()[0].milliseconds, 0.0f);
  wanted = true;
  plan_.execute();
  EXPECT_EQ(plan_.timings()[0].milliseconds, measured) << "not timed again";
}

TEST_F(FramePlanTest, ReadsBackRequestedImageEveryFrame) {
  const History history = plan_.history("count", format);
  add("count", history.previous, history.current);
  plan_.read_back(history.current);
  plan_.compile();
  for (int frame = 1; frame <= 3; ++frame) {
    plan_.execute();
    const std::vector<std::uint8_t> bytes = plan_.read();
    const auto downloaded = plan_.latest(history.current).download();
    ASSERT_EQ(bytes.size(), downloaded.size());
    EXPECT_EQ(std::memcmp(bytes.data(), downloaded.data(), bytes.size()), 0);
    EXPECT_EQ(value(history.current), static_cast<float>(frame));
  }
}

TEST_F(FramePlanTest, SkipsPassesWhoseConditionIsFalse) {
  const auto a = image("a"), b = image("b");
  bool wanted = false;
  add("maybe", a, b, 7.0f).when([&] { return wanted; });
  plan_.compile();
  plan_.execute();
  EXPECT_EQ(value(b), 0.0f);
  EXPECT_LT(plan_.timings()[0].milliseconds, 0.0f);
  wanted = true;
  plan_.execute();
  EXPECT_EQ(value(b), 7.0f);
  EXPECT_GE(plan_.timings()[0].milliseconds, 0.0f);
}

TEST_F(FramePlanTest, OnlyWhenSkipsAllPassesDeclaredWithin) {
  const auto a = image("a"), b = image("b"), c = image("c"), d = image("d");
  bool outer = false, own = true;
  plan_.only_when([&] { return outer; },
                  [&] {
                    add("first", a, b, 2.0f);
                    add("second", a, c, 3.0f).when([&] { return own; });
                  });
  add("always", a, d, 4.0f);
  plan_.compile();
  plan_.execute();
  EXPECT_EQ(value(b), 0.0f);
  EXPECT_EQ(value(c), 0.0f);
  EXPECT_EQ(value(d), 4.0f);
  outer = true;
  own = false;
  plan_.execute();
  EXPECT_EQ(value(b), 2.0f);
  EXPECT_EQ(value(c), 0.0f) << "its own condition counts too";
  own = true;
  plan_.execute();
  EXPECT_EQ(value(c), 3.0f);
}

TEST_F(FramePlanTest, WhatOneOfTwoPassesWritesIsLeftOutInNoFrame) {
  const auto a = image("a"), either = image("either"), one = image("one");
  bool first = false;
  plan_.only_when([&] { return first; },
                  [&] {
                    add("first", a, either, 2.0f);
                    add("only first", a, one, 5.0f);
                  },
                  [&] { add("second", a, either, 3.0f); });
  plan_.share_memory();
  plan_.compile();
  plan_.execute();
  EXPECT_EQ(value(either), 3.0f);
  first = true;
  plan_.execute();
  EXPECT_EQ(value(either), 2.0f);
  EXPECT_EQ(value(one), 5.0f);
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

TEST_F(FramePlanTest, ListsEveryWrittenImageOnce) {
  const auto a = image("a"), b = image("b");
  const History history = plan_.history("history", format);
  add("to b", a, b);
  add("to b again", a, b);
  add("to history", b, history.current);
  plan_.compile();
  ASSERT_EQ(plan_.views().size(), 2u);
  EXPECT_EQ(plan_.views()[0].name, "b");
  EXPECT_EQ(plan_.views()[1].name, "history");
}

TEST_F(FramePlanTest, ErrorNamesWrongFormat) {
  const auto a = plan_.image("vectors", VK_FORMAT_R32G32B32A32_SFLOAT);
  add("brighten", a, image("b"));
  expect_complaint({"\"brighten\"", "binding 0", "\"given\"", "\"vectors\""});
}

TEST_F(FramePlanTest, ErrorNamesMissingBinding) {
  plan_.pass("brighten", program_).read(image("a")).constants(1.0f).dispatch({1, 1});
  expect_complaint({"\"brighten\"", "binding 1", "\"sum\""});
}

TEST_F(FramePlanTest, ErrorNamesSurplusResource) {
  const auto a = image("a"), b = image("b"), c = image("spare");
  plan_.pass("brighten", program_).read(a).write(b).read(c).constants(1.0f).dispatch({1, 1});
  expect_complaint({"\"brighten\"", "\"spare\""});
}

TEST_F(FramePlanTest, ErrorNamesReadImageThatShaderWrites) {
  const auto a = image("a"), b = image("b");
  plan_.pass("brighten", program_).read(a).read(b).constants(1.0f).dispatch({1, 1});
  expect_complaint({"\"brighten\"", "binding 1", "\"sum\"", "\"b\"", "only read"});
}

TEST_F(FramePlanTest, ErrorNamesWrittenImageThatIsReadonly) {
  const auto a = image("a"), b = image("b");
  plan_.pass("brighten", program_).write(a).write(b).constants(1.0f).dispatch({1, 1});
  expect_complaint({"\"brighten\"", "binding 0", "\"given\"", "readonly"});
}

TEST_F(FramePlanTest, ErrorNamesBufferBoundAsImage) {
  const auto buffer = plan_.buffer("bytes", 64, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, Memory::device);
  plan_.pass("brighten", program_).read(buffer).write(image("b")).constants(1.0f).dispatch({1, 1});
  expect_complaint({"\"brighten\"", "binding 0", "buffer \"bytes\""});
}

TEST_F(FramePlanTest, ErrorNamesWrongPushConstantSize) {
  const auto a = image("a"), b = image("b");
  plan_.pass("brighten", program_).read(a).write(b).constants(glm::vec2(1.0f)).dispatch({1, 1});
  expect_complaint({"\"brighten\"", "4 bytes of constants", "given 8"});
}

TEST_F(FramePlanTest, ErrorNamesPassWithoutDispatch) {
  plan_.pass("brighten", program_).read(image("a")).write(image("b")).constants(1.0f);
  expect_complaint({"\"brighten\"", "never dispatched"});
}

TEST_F(FramePlanTest, RejectsExecuteBeforeAndDeclarationsAfterCompile) {
  EXPECT_THROW(plan_.execute(), GpuError);
  plan_.compile();
  EXPECT_THROW(plan_.image("late", format), GpuError);
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
