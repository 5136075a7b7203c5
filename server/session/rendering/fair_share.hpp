#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "stream/encoded_frame.hpp"

namespace heliograph::session {

using stream::Clock;

/// Divides the time of one device between views in equal parts, however long their frames take:
/// start-time fair queueing (Goyal, Vin and Cheng, SIGCOMM 1996, with equal weights). The account
/// of each view has the virtual time at which its next frame may start; the earliest is next. A
/// view that was idle starts at the present virtual time: idle time gives no credit.
///
/// A frame is never interrupted. A view with short frames that pauses between them (its frame is
/// encoded, its viewer acknowledges) would wait for a long frame of another view after each of its
/// own. So the device waits for it during that pause, at the expense of the view it waits for,
/// before a long frame begins (anticipatory scheduling: Iyer and Druschel, SOSP 2001). After an
/// unsuccessful wait the view is skipped until it has worked again, and then for a number of turns
/// that doubles with each unsuccessful wait.
///
/// A frame may take far longer than those before it because the processors did something else.
/// Charged in full it would keep its view waiting until each of the others had as much: a second in
/// fifty views is nearly a minute. Pure logic; not thread safe.
class FairShare {
 public:
  using Key = const void*;
  using Duration = Clock::duration;

  /// Sorts views that may have work by their turn.
  void sort(std::vector<Key>& keys) const;
  /// Until when `key`, which could begin a frame now, has to wait for a view that is before it and
  /// is expected back.
  std::optional<Clock::time_point> hold_back(Key key, Clock::time_point now);
  /// `key` used the device, for `used` of the time between both: the rest was used by others at the
  /// same time.
  void charge(Key key, Clock::time_point begin, Clock::time_point end, Duration used);
  void remove(Key key) { accounts_.erase(key); }

 private:
  struct Account {
    Duration next_start{0};  // virtual time
    std::uint64_t turn = 0;  // of its last work
    Duration last_work{0};
    Duration usual_work{0};                          // of a frame, smoothed
    Duration pause{std::chrono::milliseconds(4)};    // between its frames, smoothed
    Clock::time_point ended{};                       // its last work
    std::optional<Clock::time_point> awaited_since;  // other views have been held back for it
    int failed_waits = 0;                            // since the last successful one
    std::uint64_t skipped_until_turn = 0;
    bool skipped = false;  // until its next work
  };

  Account account(Key key) const;
  void stop_waiting(Account& account, Clock::time_point now) const;
  static Duration waited_for(const Account& account, Clock::time_point now);
  static Duration wait_timeout(const Account& account);

  std::unordered_map<Key, Account> accounts_;
  Duration virtual_now_{0};  // start of the newest work
  std::uint64_t turns_ = 0;
};

}  // namespace heliograph::session
