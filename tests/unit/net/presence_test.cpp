#include "net/websocket/presence.hpp"

#include <gtest/gtest.h>

#include "net/websocket/paced_write.hpp"

namespace heliograph::net {
namespace {

using namespace std::chrono_literals;
using Verdict = Presence::Verdict;

const Presence::Clock::time_point begin{};

Presence watched() {
  return Presence(30s, 8192.0, 5s, begin);
}

TEST(Presence, ASilentPeerIsPingedAndThenGivenUp) {
  Presence peer = watched();
  EXPECT_EQ(peer.look(begin + 5s, 0, 0), Verdict::fine);
  EXPECT_EQ(peer.look(begin + 15s, 0, 0), Verdict::silent);
  EXPECT_EQ(peer.look(begin + 30s, 0, 0), Verdict::silent);
  EXPECT_EQ(peer.look(begin + 31s, 0, 0), Verdict::gone);
}

TEST(Presence, WhoIsHeardStays) {
  Presence peer = watched();
  for (auto now = 10s; now < 200s; now += 10s) {
    peer.heard(begin + now);
    EXPECT_EQ(peer.look(begin + now + 5s, 0, 0), Verdict::fine);
  }
}

TEST(Presence, WhoGoesOnTakingOneLongMessageStaysThoughItSaysNothing) {
  Presence peer = watched();
  std::uint64_t taken = 0;
  for (auto now = 5s; now < 300s; now += 5s) {
    taken += 500'000;
    EXPECT_NE(peer.look(begin + now, 7, taken), Verdict::gone) << now.count();
  }
}

TEST(Presence, ALongMessageThatIsHardlyTakenIsNoSignOfLife) {
  Presence still = watched();
  Presence dribbling = watched();
  std::uint64_t taken = 0;
  Verdict of_still = Verdict::fine;
  Verdict of_dribbling = Verdict::fine;
  for (auto now = 5s; now <= 60s; now += 5s) {
    taken += 100;
    of_still = still.look(begin + now, 7, 100'000);
    of_dribbling = dribbling.look(begin + now, 7, taken);
  }
  EXPECT_EQ(of_still, Verdict::gone);
  EXPECT_EQ(of_dribbling, Verdict::gone);
}

// The system of a client that hangs takes short messages for it for a long time.
TEST(Presence, ShortMessagesTakenAreNoSignOfLife) {
  Presence peer = watched();
  std::uint64_t write = 0;
  std::uint64_t taken = 0;
  Verdict verdict = Verdict::fine;
  for (auto now = 5s; now <= 40s; now += 5s)
    verdict = peer.look(begin + now, ++write, taken += 1'000'000);
  EXPECT_EQ(verdict, Verdict::gone);
}

TEST(PaceKeeper, LeavesAReaderThatKeepsUpAllTheTimeItNeeds) {
  PaceKeeper keeper({.patience = 30s, .bytes_per_second = 8192.0}, begin);
  for (auto now = 0s; now < 1000s; now += 10s) {
    EXPECT_GT(keeper.deadline(begin + now), begin + now + 10s);
    keeper.took(100'000);
  }
}

TEST(PaceKeeper, EndsWhereNothingOrTooLittleIsTaken) {
  PaceKeeper keeper({.patience = 30s, .bytes_per_second = 8192.0}, begin);
  EXPECT_EQ(keeper.deadline(begin), begin + 30s);
  keeper.took(8192);
  EXPECT_EQ(keeper.deadline(begin + 10s), begin + 31s);
  keeper.took(8192 * 1000);
  EXPECT_EQ(keeper.deadline(begin + 10s), begin + 40s);
}

}  // namespace
}  // namespace heliograph::net
