#include "session/rendering/fair_share.hpp"

#include <algorithm>
#include <tuple>

namespace heliograph::session {
namespace {

using std::chrono::milliseconds;

/// Longer pauses are not worth waiting for.
constexpr milliseconds most_patience{40};
/// How often it doubles for how many turns nobody waits for who was awaited in vain.
constexpr int most_doublings = 6;

}  // namespace

void FairShare::arrange(std::vector<Key>& keys) const {
  std::stable_sort(keys.begin(), keys.end(), [&](Key a, Key b) {
    const Account first = account(a);
    const Account second = account(b);
    // Among equals, whose last turn is longest ago.
    return std::tie(first.next_start, first.turn) < std::tie(second.next_start, second.turn);
  });
}

std::optional<Clock::time_point> FairShare::hold_back(Key key, Clock::time_point now) {
  const Account candidate = account(key);
  std::optional<Clock::time_point> until;
  for (auto& [other, it] : accounts_) {
    if (other == key || it.turn == 0 || it.given_up || turns_ < it.awaited_from_turn) continue;
    const bool before = std::max(it.next_start, now_) < candidate.next_start;
    if (!before || candidate.last_work <= patience(it)) continue;
    const Clock::time_point deadline = it.ended + patience(it);
    if (now < deadline) {
      if (!it.awaited_since) it.awaited_since = now;
      until = until ? std::max(*until, deadline) : deadline;
    } else if (it.awaited_since) {
      give_up(it, now);
    }
  }
  return until;
}

void FairShare::give_up(Account& account, Clock::time_point now) const {
  account.next_start = std::max(account.next_start, now_) + (now - *account.awaited_since);
  account.awaited_since.reset();
  account.given_up = true;
  account.waits_in_vain = std::min(account.waits_in_vain + 1, most_doublings);
  account.awaited_from_turn = turns_ + (std::uint64_t{1} << account.waits_in_vain);
  // Perhaps it only takes longer than it was given.
  account.pause = std::min<Duration>(2 * account.pause, most_patience / 2);
}

void FairShare::charge(Key key, Clock::time_point begin, Clock::time_point end) {
  Account paid = account(key);
  now_ = std::max(now_, paid.next_start);
  const Duration pause = begin - paid.ended;
  const bool undisturbed = paid.turn > 0 && paid.turn == turns_;
  if (undisturbed && pause <= most_patience) paid.pause += (pause - paid.pause) / 4;
  if (paid.awaited_since) {
    paid.next_start += begin - *paid.awaited_since;
    paid.waits_in_vain = 0;
    paid.awaited_since.reset();
  }
  paid.given_up = false;
  paid.last_work = end - begin;
  paid.next_start += paid.last_work;
  paid.turn = ++turns_;
  paid.ended = end;
  accounts_[key] = paid;
}

FairShare::Account FairShare::account(Key key) const {
  const auto found = accounts_.find(key);
  Account account = found == accounts_.end() ? Account() : found->second;
  account.next_start = std::max(account.next_start, now_);
  return account;
}

FairShare::Duration FairShare::patience(const Account& account) {
  return std::clamp<Duration>(2 * account.pause, milliseconds(2), most_patience);
}

}  // namespace heliograph::session
