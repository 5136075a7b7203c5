#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "stream/encoded_frame.hpp"

namespace heliograph::session {

using stream::Clock;

/// Divides the time of one device among those who want it, in equal parts, however different their
/// pieces of work are: start-time fair queueing (Goyal, Vin and Cheng, SIGCOMM 1996, with equal
/// weights). Everybody's account says when, in a time that passes as work is done, the next piece
/// may start; the earliest is next. Who wanted nothing for a while starts now and has saved nothing
/// up.
///
/// A piece is never interrupted. Somebody with short pieces, who needs a moment between them (its
/// picture is encoded, its viewer answers), would wait for a long piece of another after each of
/// its own. So the device waits that moment, at the expense of who it waits for, before it begins a
/// long piece (anticipatory scheduling: Iyer and Druschel, SOSP 2001). Who was awaited in vain is
/// given up until it has worked again, and ever more seldom awaited. Pure logic; not thread safe.
class FairShare {
 public:
  using Key = const void*;
  using Duration = Clock::duration;

  /// Puts those who may want to work into the order of their turns.
  void arrange(std::vector<Key>& keys) const;
  /// Until when `key`, which could begin a piece now, has to wait for one who is before it and will
  /// be back in a moment.
  std::optional<Clock::time_point> hold_back(Key key, Clock::time_point now);
  /// `key` did a piece of work.
  void charge(Key key, Clock::time_point begin, Clock::time_point end);
  void forget(Key key) { accounts_.erase(key); }

 private:
  struct Account {
    Duration next_start{0};
    std::uint64_t turn = 0;  // of its last piece
    Duration last_work{0};
    Duration pause{std::chrono::milliseconds(4)};    // between its pieces, smoothed
    Clock::time_point ended{};                       // its last piece
    std::optional<Clock::time_point> awaited_since;  // others have been held back for it
    int waits_in_vain = 0;                           // since the last that was not
    std::uint64_t awaited_from_turn = 0;
    bool given_up = false;  // until its next piece
  };

  Account account(Key key) const;
  void give_up(Account& account, Clock::time_point now) const;
  static Duration patience(const Account& account);

  std::unordered_map<Key, Account> accounts_;
  Duration now_{0};  // start of the newest piece
  std::uint64_t turns_ = 0;
};

}  // namespace heliograph::session
