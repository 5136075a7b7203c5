// What is wrong with a declaration is said by name.
#include <glm/glm.hpp>

#include "tests/gpu/frame_plan/frame_plan_fixture.hpp"

namespace heliograph::gpu {
namespace {

TEST_F(FramePlanTest, ErrorNamesWrongFormat) {
  const auto a = plan_.image("vectors", VK_FORMAT_R32G32B32A32_SFLOAT);
  add("brighten", a, image("b"));
  expect_complaint({"\"brighten\"", "binding 0", "\"given\"", "\"vectors\""});
}

TEST_F(FramePlanTest, ErrorNamesFloatsThatAreFetchedAsIntegers) {
  const ComputeProgram fetch(device_, test::shaders::fetch_integers);
  plan_.pass("count", fetch).read(image("floats")).write(image("b")).dispatch({1, 1});
  expect_complaint({"\"count\"", "binding 0", "\"given\"", "integers", "\"floats\"", "r32f"});
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

}  // namespace
}  // namespace heliograph::gpu
