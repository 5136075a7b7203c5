#include "net/websocket/liveness.hpp"

#include <gtest/gtest.h>

#include "net/websocket/paced_write.hpp"

namespace heliograph::net {
namespace {

using namespace std::chrono_literals;
using Verdict = Liveness::Verdict;

const Liveness::Clock::time_point begin{};

Liveness watched() {
  return Liveness(30s, 8192.0, 5s, begin);
}

TEST(Liveness, SilentPeerIsPingedAndThenLost) {
  Liveness peer = watched();
  EXPECT_EQ(peer.check(begin + 5s, 0, 0), Verdict::alive);
  EXPECT_EQ(peer.check(begin + 15s, 0, 0), Verdict::silent);
  EXPECT_EQ(peer.check(begin + 30s, 0, 0), Verdict::silent);
  EXPECT_EQ(peer.check(begin + 31s, 0, 0), Verdict::lost);
}

TEST(Liveness, PeerThatSendsStaysAlive) {
  Liveness peer = watched();
  for (auto now = 10s; now < 200s; now += 10s) {
    peer.received(begin + now);
    EXPECT_EQ(peer.check(begin + now + 5s, 0, 0), Verdict::alive);
  }
}

TEST(Liveness, SilentPeerThatKeepsReadingALongMessageStaysAlive) {
  Liveness peer = watched();
  std::uint64_t acknowledged = 0;
  for (auto now = 5s; now < 300s; now += 5s) {
    acknowledged += 500'000;
    EXPECT_NE(peer.check(begin + now, 7, acknowledged), Verdict::lost) << now.count();
  }
}

TEST(Liveness, LongMessageReadTooSlowlyIsNoSignOfLife) {
  Liveness still = watched();
  Liveness dribbling = watched();
  std::uint64_t acknowledged = 0;
  Verdict of_still = Verdict::alive;
  Verdict of_dribbling = Verdict::alive;
  for (auto now = 5s; now <= 60s; now += 5s) {
    acknowledged += 100;
    of_still = still.check(begin + now, 7, 100'000);
    of_dribbling = dribbling.check(begin + now, 7, acknowledged);
  }
  EXPECT_EQ(of_still, Verdict::lost);
  EXPECT_EQ(of_dribbling, Verdict::lost);
}

// The system of a client that hangs acknowledges short messages for a long time.
TEST(Liveness, AcknowledgedShortMessagesAreNoSignOfLife) {
  Liveness peer = watched();
  std::uint64_t write = 0;
  std::uint64_t acknowledged = 0;
  Verdict verdict = Verdict::alive;
  for (auto now = 5s; now <= 40s; now += 5s)
    verdict = peer.check(begin + now, ++write, acknowledged += 1'000'000);
  EXPECT_EQ(verdict, Verdict::lost);
}

TEST(PaceKeeper, DoesNotLimitTheDurationForAClientThatKeepsUp) {
  PaceKeeper keeper({.timeout = 30s, .bytes_per_second = 8192.0}, begin);
  for (auto now = 0s; now < 1000s; now += 10s) {
    EXPECT_GT(keeper.deadline(begin + now), begin + now + 10s);
    keeper.took(100'000);
  }
}

TEST(PaceKeeper, ExpiresIfNothingOrTooLittleIsRead) {
  PaceKeeper keeper({.timeout = 30s, .bytes_per_second = 8192.0}, begin);
  EXPECT_EQ(keeper.deadline(begin), begin + 30s);
  keeper.took(8192);
  EXPECT_EQ(keeper.deadline(begin + 10s), begin + 31s);
  keeper.took(8192 * 1000);
  EXPECT_EQ(keeper.deadline(begin + 10s), begin + 40s);
}

}  // namespace
}  // namespace heliograph::net
