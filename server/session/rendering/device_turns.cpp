#include "session/rendering/device_turns.hpp"

#include <algorithm>

namespace heliograph::session {

void DeviceTurns::sort(std::vector<Contender>& contenders) const {
  std::vector<FairShare::Key> moving;
  std::vector<FairShare::Key> refining;
  for (const Contender& contender : contenders) {
    (contender.refines ? refining : moving).push_back(contender.view);
  }
  among_refining_.sort(refining);
  if (!refining.empty()) moving.push_back(all_refining());
  shares_.sort(moving);
  contenders.clear();
  for (const FairShare::Key key : moving) {
    if (key != all_refining()) {
      contenders.push_back({.view = key, .refines = false});
      continue;
    }
    for (const FairShare::Key view : refining) {
      contenders.push_back({.view = view, .refines = true});
    }
  }
}

std::optional<Clock::time_point> DeviceTurns::hold_back(const Contender& contender,
                                                        Clock::time_point now) {
  if (!contender.refines) return shares_.hold_back(contender.view, now);
  // Without a value it is the least.
  return std::max(shares_.hold_back(all_refining(), now),
                  among_refining_.hold_back(contender.view, now));
}

void DeviceTurns::charge(const Contender& contender, Clock::time_point begin,
                         Clock::time_point end) {
  if (contender.refines) among_refining_.charge(contender.view, begin, end);
  shares_.charge(contender.refines ? all_refining() : contender.view, begin, end);
}

void DeviceTurns::remove(FairShare::Key view) {
  shares_.remove(view);
  among_refining_.remove(view);
}

}  // namespace heliograph::session
