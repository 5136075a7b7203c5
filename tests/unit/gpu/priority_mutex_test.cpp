#include "gpu/device/priority_mutex.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <thread>
#include <vector>

namespace heliograph::gpu {
namespace {

/// Long enough for a thread to begin to wait.
constexpr std::chrono::milliseconds settling{200};

TEST(PriorityMutex, WhoGoesFirstOvertakesWhoHasWaitedLonger) {
  PriorityMutex mutex;
  std::string order;
  std::vector<std::jthread> threads;
  {
    const auto held = mutex.lock_after();
    for (int i = 0; i < 4; ++i) {
      threads.emplace_back([&] {
        const auto lock = mutex.lock_after();
        order += 'a';
      });
    }
    std::this_thread::sleep_for(settling);
    for (int i = 0; i < 2; ++i) {
      threads.emplace_back([&] {
        const auto lock = mutex.lock_first();
        order += 'f';
      });
    }
    std::this_thread::sleep_for(settling);
  }
  threads.clear();
  EXPECT_EQ(order, "ffaaaa");
}

TEST(PriorityMutex, OneThreadHoldsIt) {
  PriorityMutex mutex;
  constexpr int rounds = 2000;
  int count = 0;
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 4; ++i) {
      threads.emplace_back([&, first = i % 2 == 0] {
        for (int round = 0; round < rounds; ++round) {
          const auto lock = first ? mutex.lock_first() : mutex.lock_after();
          ++count;
        }
      });
    }
  }
  EXPECT_EQ(count, 4 * rounds);
}

}  // namespace
}  // namespace heliograph::gpu
