#include "protocol/json/pending_answer.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace heliograph::protocol {
namespace {

TEST(PendingAnswer, RefusesPartsBeyondItsOwnLimit) {
  const auto all = std::make_shared<AnswerMemory>(1000u << 20);
  PendingAnswer answer(2u << 20, all);
  EXPECT_TRUE(answer.reserve(1u << 20));
  EXPECT_TRUE(answer.reserve(1u << 20));
  const auto refused = answer.reserve(1);
  EXPECT_EQ(refused.error().code, ErrorCode::too_large);
  EXPECT_EQ(refused.error().limit, "2 MiB");
  EXPECT_EQ(answer.reserve(std::numeric_limits<std::size_t>::max()).error().code,
            ErrorCode::too_large);
  EXPECT_EQ(all->used, 2u << 20) << "refused parts take no memory";
}

TEST(PendingAnswer, SharesMemoryWithAllOthers) {
  const auto all = std::make_shared<AnswerMemory>(100);
  auto first = std::make_unique<PendingAnswer>(90, all);
  PendingAnswer second(90, all);
  ASSERT_TRUE(first->reserve(80));
  EXPECT_EQ(second.reserve(30).error().code, ErrorCode::full);
  EXPECT_TRUE(second.reserve(20));
  first.reset();
  EXPECT_EQ(all->used, 20u);
  EXPECT_TRUE(second.reserve(70)) << "what was refused does not count against its own limit";
}

}  // namespace
}  // namespace heliograph::protocol
