#include "session/fair_share.hpp"

#include <algorithm>
#include <tuple>

namespace heliograph::session {
namespace {

using std::chrono::milliseconds;

/// Longer pauses are not worth waiting for.
constexpr milliseconds most_patience{40};
/// Who did not come back in time is not waited for again so soon.
constexpr milliseconds disappointment{500};

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
    if (other == key || it.turn == 0) continue;
    const bool before = std::max(it.next_start, now_) < candidate.next_start;
    if (!before || candidate.last_work <= patience(it) || now < it.not_awaited_until) continue;
    const Clock::time_point deadline = it.ended + patience(it);
    if (now < deadline) {
      until = until ? std::max(*until, deadline) : deadline;
    } else if (it.turn == turns_) {
      it.not_awaited_until = now + disappointment;
    }
  }
  return until;
}

void FairShare::charge(Key key, Clock::time_point begin, Clock::time_point end) {
  Account paid = account(key);
  now_ = std::max(now_, paid.next_start);
  // The device was kept free for it if it was the last to work.
  const bool awaited = paid.turn > 0 && paid.turn == turns_;
  const Duration pause = begin - paid.ended;
  if (awaited && pause <= most_patience) {
    paid.pause += (pause - paid.pause) / 4;
    paid.next_start += pause;
  }
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
