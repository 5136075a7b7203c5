#include "session/rendering/fair_share.hpp"

#include <algorithm>
#include <tuple>

namespace heliograph::session {
namespace {

using std::chrono::milliseconds;

/// The device does not wait for longer pauses.
constexpr milliseconds max_wait{40};
/// A frame is charged as at most so many of its view's usual ones.
constexpr int most_usual_frames = 3;
/// How often the number of turns doubles for which a view is skipped after unsuccessful waits.
constexpr int max_doublings = 6;

}  // namespace

void FairShare::sort(std::vector<Key>& keys) const {
  std::stable_sort(keys.begin(), keys.end(), [&](Key a, Key b) {
    const Account first = account(a);
    const Account second = account(b);
    // Among equals the one whose last turn is longest ago.
    return std::tie(first.next_start, first.turn) < std::tie(second.next_start, second.turn);
  });
}

std::optional<Clock::time_point> FairShare::hold_back(Key key, Clock::time_point now) {
  const Account candidate = account(key);
  std::optional<Clock::time_point> until;
  for (auto& [other, account] : accounts_) {
    if (other == key || account.turn == 0 || account.skipped || turns_ < account.skipped_until_turn)
      continue;
    const bool before = std::max(account.next_start, virtual_now_) < candidate.next_start;
    if (!before || candidate.last_work <= wait_timeout(account)) continue;
    const Clock::time_point deadline = account.ended + wait_timeout(account);
    if (now < deadline) {
      if (!account.awaited_since) account.awaited_since = now;
      until = until ? std::max(*until, deadline) : deadline;
    } else if (account.awaited_since) {
      stop_waiting(account, now);
    }
  }
  return until;
}

void FairShare::stop_waiting(Account& account, Clock::time_point now) const {
  account.next_start = std::max(account.next_start, virtual_now_) + waited_for(account, now);
  account.awaited_since.reset();
  account.skipped = true;
  account.failed_waits = std::min(account.failed_waits + 1, max_doublings);
  account.skipped_until_turn = turns_ + (std::uint64_t{1} << account.failed_waits);
  // It may only need longer than the timeout.
  account.pause = std::min<Duration>(wait_timeout(account), max_wait / 2);
}

void FairShare::charge(Key key, Clock::time_point begin, Clock::time_point end, Duration used) {
  Account paid = account(key);
  virtual_now_ = std::max(virtual_now_, paid.next_start);
  const Duration waited = waited_for(paid, begin);
  // Frames of several views that share an account may overlap.
  const Duration pause = std::max<Duration>(begin - paid.ended, Duration::zero());
  const bool undisturbed = paid.turn > 0 && paid.turn == turns_;
  if (undisturbed && pause <= max_wait) paid.pause += (pause - paid.pause) / 4;
  if (paid.awaited_since) {
    paid.next_start += waited;
    paid.failed_waits = 0;
    paid.awaited_since.reset();
  }
  paid.skipped = false;
  paid.last_work = used;
  if (paid.turn == 0) paid.usual_work = paid.last_work;
  paid.next_start += std::min(paid.last_work, most_usual_frames * paid.usual_work);
  paid.usual_work += (paid.last_work - paid.usual_work) / 4;
  paid.turn = ++turns_;
  paid.ended = end;
  accounts_[key] = paid;
}

FairShare::Account FairShare::account(Key key) const {
  const auto entry = accounts_.find(key);
  Account account = entry == accounts_.end() ? Account() : entry->second;
  account.next_start = std::max(account.next_start, virtual_now_);
  return account;
}

/// The view that was held back may have gone, and the device been idle or busy since then: no view
/// was held back for longer than the timeout.
FairShare::Duration FairShare::waited_for(const Account& account, Clock::time_point now) {
  if (!account.awaited_since) return Duration::zero();
  const Clock::time_point deadline = account.ended + wait_timeout(account);
  return std::max(std::min(now, deadline) - *account.awaited_since, Duration::zero());
}

FairShare::Duration FairShare::wait_timeout(const Account& account) {
  return std::clamp<Duration>(2 * account.pause, milliseconds(2), max_wait);
}

}  // namespace heliograph::session
