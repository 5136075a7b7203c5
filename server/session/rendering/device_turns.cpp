#include "session/rendering/device_turns.hpp"

#include <algorithm>
#include <span>

namespace heliograph::session {

void DeviceTurns::sort(std::vector<Contender>& contenders) const {
  std::vector<FairShare::Key> shares;
  std::vector<FairShare::Key> starting;
  std::vector<FairShare::Key> refining;
  for (const auto& [view, kind] : contenders) {
    (kind == TurnKind::starting   ? starting
     : kind == TurnKind::refining ? refining
                                  : shares)
        .push_back(view);
  }
  among_starting_.sort(starting);
  among_refining_.sort(refining);
  if (!starting.empty()) shares.push_back(all_starting());
  if (!refining.empty()) shares.push_back(all_refining());
  shares_.sort(shares);
  contenders.clear();
  const auto append = [&](std::span<const FairShare::Key> views, TurnKind kind) {
    for (const FairShare::Key view : views) contenders.push_back({.view = view, .kind = kind});
  };
  for (const FairShare::Key key : shares) {
    if (key == all_starting()) {
      append(starting, TurnKind::starting);
    } else if (key == all_refining()) {
      append(refining, TurnKind::refining);
    } else {
      append({&key, 1}, TurnKind::moving);
    }
  }
}

FairShare::Key DeviceTurns::in_shares(const Contender& contender) const {
  switch (contender.kind) {
    case TurnKind::moving:
      break;
    case TurnKind::starting:
      return all_starting();
    case TurnKind::refining:
      return all_refining();
  }
  return contender.view;
}

std::optional<Clock::time_point> DeviceTurns::hold_back(const Contender& contender,
                                                        Clock::time_point now) {
  const auto until = shares_.hold_back(in_shares(contender), now);
  if (contender.kind != TurnKind::refining) return until;
  // Without a value it is the least.
  return std::max(until, among_refining_.hold_back(contender.view, now));
}

DeviceTurns::Frame DeviceTurns::begin(Clock::time_point now) {
  pass_time(now);
  ++frames_;
  return {.begun = now, .used_before = used_};
}

void DeviceTurns::finish(const Contender& contender, const Frame& frame, Clock::time_point now) {
  drop(now);
  charge(contender, frame.begun, now, used_ - frame.used_before);
}

void DeviceTurns::drop(Clock::time_point now) {
  pass_time(now);
  --frames_;
}

void DeviceTurns::pass_time(Clock::time_point now) {
  now = std::max(now, used_until_);
  if (frames_ > 0) used_ += (now - used_until_) / frames_;
  used_until_ = now;
}

void DeviceTurns::charge(const Contender& contender, Clock::time_point begin, Clock::time_point end,
                         FairShare::Duration used) {
  switch (contender.kind) {
    case TurnKind::moving:
      moving_frame_ += (used - moving_frame_) / (moving_frame_ == FairShare::Duration(0) ? 1 : 4);
      break;
    case TurnKind::starting:
      among_starting_.charge(contender.view, begin, end, used);
      if (moving_frame_ > FairShare::Duration(0)) used = std::min(used, moving_frame_);
      break;
    case TurnKind::refining:
      among_refining_.charge(contender.view, begin, end, used);
      break;
  }
  shares_.charge(in_shares(contender), begin, end, used);
}

void DeviceTurns::remove(FairShare::Key view) {
  shares_.remove(view);
  among_starting_.remove(view);
  among_refining_.remove(view);
}

}  // namespace heliograph::session
