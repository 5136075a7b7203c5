#include "session/worker.hpp"

#include <gtest/gtest.h>

#include <barrier>
#include <future>
#include <memory>
#include <vector>

namespace heliograph::session {
namespace {

TEST(Worker, ThreadsRunTasksAtTheSameTime) {
  constexpr int tasks = 3;
  // No task ends before all have begun.
  const auto all_begun = std::make_shared<std::barrier<>>(tasks + 1);
  Worker worker("test", tasks, tasks);
  for (int i = 0; i < tasks; ++i) {
    ASSERT_TRUE(worker.post([all_begun] { all_begun->arrive_and_wait(); }));
  }
  all_begun->arrive_and_wait();
}

TEST(Worker, OneThreadRunsTasksInOrder) {
  std::vector<int> order;
  std::promise<void> done;
  Worker worker("test", 8);
  for (int i = 0; i < 4; ++i) {
    ASSERT_TRUE(worker.post([&order, i] { order.push_back(i); }));
  }
  ASSERT_TRUE(worker.post([&done] { done.set_value(); }));
  done.get_future().wait();
  EXPECT_EQ(order, (std::vector<int>{0, 1, 2, 3}));
}

TEST(Worker, RefusesTasksBeyondItsCapacity) {
  std::promise<void> release, began;
  Worker worker("test", 1);
  ASSERT_TRUE(worker.post([&] {
    began.set_value();
    release.get_future().wait();
  }));
  began.get_future().wait();
  EXPECT_TRUE(worker.post([] {}));
  EXPECT_FALSE(worker.has_room());
  EXPECT_FALSE(worker.post([] {}));
  release.set_value();
}

}  // namespace
}  // namespace heliograph::session
