#include "session/devices/placement.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace heliograph::session {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr std::uint64_t gibibyte = 1ull << 30;

TEST(Placement, SpreadsSessionsThatAreOpenedAtOnce) {
  std::array<DeviceLoad, 3> devices{};
  for (int i = 0; i < 7; ++i) ++devices[place_session(devices, gibibyte)].sessions;
  EXPECT_EQ(devices[0].sessions, 3u);
  EXPECT_EQ(devices[1].sessions, 2u);
  EXPECT_EQ(devices[2].sessions, 2u);
}

TEST(Placement, PrefersTheIdleDeviceOfSeveralSessionsToTheBusyOneOfOne) {
  const std::vector<DeviceLoad> devices{{.busy = 0.9, .sessions = 1}, {.busy = 0.0, .sessions = 4}};
  EXPECT_EQ(place_session(devices, 0), 1u);
}

TEST(Placement, OfBusyDevicesTheOneWithFewerSessionsGivesMoreTime) {
  const std::vector<DeviceLoad> devices{{.busy = 1.0, .sessions = 8}, {.busy = 1.0, .sessions = 2}};
  EXPECT_EQ(place_session(devices, 0), 1u);
}

TEST(Placement, AvoidsADeviceWithoutMemoryForTheSession) {
  std::vector<DeviceLoad> devices{{.free_memory = gibibyte}, {.busy = 1.0, .sessions = 9}};
  EXPECT_EQ(place_session(devices, gibibyte), 0u);
  EXPECT_EQ(place_session(devices, gibibyte + 1), 1u) << "that does not tell";
  devices[1].free_memory = gibibyte;
  EXPECT_EQ(place_session(devices, 2 * gibibyte), 0u) << "none has enough";
}

TEST(Placement, AmongEquallyLoadedDevicesMoreFreeMemoryDecides) {
  const std::vector<DeviceLoad> devices{{.free_memory = 2 * gibibyte},
                                        {.free_memory = 3 * gibibyte}};
  EXPECT_EQ(place_session(devices, gibibyte), 1u);
}

TEST(Placement, ALostDeviceGetsSessionsOnlyIfAllAreLost) {
  std::vector<DeviceLoad> devices{{.ready = false},
                                  {.busy = 1.0, .sessions = 20, .free_memory = 0}};
  EXPECT_EQ(place_session(devices, gibibyte), 1u);
  devices[1].ready = false;
  EXPECT_EQ(place_session({devices.data(), 1}, gibibyte), 0u);
}

TEST(Placement, ASessionTakesMoreMemoryWithMorePixels) {
  EXPECT_GT(session_memory(1920 * 1080), session_memory(1280 * 720) + 500ull * 1000 * 1000);
}

TEST(BusyShare, FollowsThePartOfTheTimeThatIsWork) {
  BusyShare share;
  Clock::time_point now{seconds(100)};
  EXPECT_EQ(share.at(now), 0.0);
  for (int frame = 0; frame < 3000; ++frame, now += milliseconds(10)) {
    share.add(now, now + milliseconds(4));
  }
  EXPECT_NEAR(share.at(now), 0.4, 0.02);
  for (int frame = 0; frame < 3000; ++frame, now += milliseconds(10)) {
    share.add(now, now + milliseconds(10));
  }
  EXPECT_NEAR(share.at(now), 1.0, 0.01);
  EXPECT_LT(share.at(now + seconds(30)), 0.01);
}

}  // namespace
}  // namespace heliograph::session
